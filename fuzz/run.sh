#!/bin/sh
# Fuzzes a loader: fuzz/run.sh scene_file|gltf [SECONDS]. Starts from the shipped scenes and small models, which are copied into a
# temporary folder, and from ../shared/assets if it is there. What is found stays in fuzz/artifacts.
set -eu
cd "$(dirname "$0")/.."
target=$1
seconds=${2:-600}
case $target in
    scene_file) names='*.ron' ;;
    gltf) names='*.gl[tb]*' ;;
    *) echo "there is no target $target" >&2; exit 2 ;;
esac
seeds=$(mktemp -d)
trap 'rm -rf "$seeds"' EXIT
# Models of different folders have the same names.
find scenes ../shared/assets -name "$names" -size -64k 2>/dev/null | while read -r file; do
    cp "$file" "$seeds/$(echo "$file" | tr / _)"
done
cargo +nightly fuzz run "$target" "$seeds" -- -max_total_time="$seconds" -dict="fuzz/$target.dict" \
    -max_len=65536 -rss_limit_mb=2048 -timeout=20
