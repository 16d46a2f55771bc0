#!/bin/sh
# Makes the sheets of the timelines in this folder: frames of a scene, then some of them side by side.
#
#     cargo build --release && docs/sheets.sh
#
# LUMINAIRE names another program than the release build. Takes minutes where Vulkan is software.
set -eu
cd "$(dirname "$0")/.."
luminaire="${LUMINAIRE:-target/release/luminaire}"
frames="$(mktemp -d)"
trap 'rm -r "$frames"' EXIT

# sheet PIPELINE SCENE FPS COLUMNS FRAME...: frame n shows the scene n / FPS seconds after it began.
sheet() {
    pipeline="$1" scene="$2" fps="$3" columns="$4"
    shift 4
    sets=""
    [ "$pipeline" != pbr ] || sets="--set sun_shadow_texels=8192"
    images=""
    for frame in "$@"; do
        # shellcheck disable=SC2086 # An option and its value.
        "$luminaire" render "pipelines/$pipeline.ron" --scene "scenes/$scene.ron" --frames "$frame..=$frame" --fps "$fps" \
            --size 1024x576 $sets -o "$frames/$scene.%04d.png"
        images="$images $frames/$scene.$(printf %04d "$frame").png"
    done
    # shellcheck disable=SC2086 # One word for each image.
    "$luminaire" sheet $images --columns "$columns" --shrink 4 -o "docs/$scene.png"
}

sheet pbr day_night 0.5 4 0 2 4 5 6 8 10 11
sheet pbr wall_removed 5 3 9 10 11 12 14 21
sheet pbr spawned 1 4 0 1 2 3 4 5 6 7
sheet sky sun_path 8 4 0 80 119 128
