#!/bin/sh
# Builds Luminaire and renders its material gallery into materials.png.
#
# Rendering needs a Vulkan adapter. If none is found, Mesa's software driver (Debian's package mesa-vulkan-drivers) can stand in:
# with --install-missing it is installed without a question, otherwise you are asked.
set -eu
cd "$(dirname "$0")"

INSTALL=ask
[ "${1:-}" = "--install-missing" ] && INSTALL=yes

cargo build

if ! target/debug/luminaire info >/dev/null 2>&1; then
    echo "No Vulkan adapter was found. Mesa's software driver (package mesa-vulkan-drivers) renders without a GPU."
    if [ "$INSTALL" = ask ]; then
        printf "Install it with apt-get now? [y/N] "
        read -r ANSWER || ANSWER=n
        case "$ANSWER" in
            y | Y | yes) ;;
            *)
                echo "Nothing was installed. Install a Vulkan driver and run this again."
                exit 1
                ;;
        esac
    fi
    ROOT=""
    [ "$(id -u)" = 0 ] || ROOT="sudo"
    $ROOT apt-get update
    $ROOT apt-get install -y mesa-vulkan-drivers
fi

target/debug/luminaire render pipelines/pbr.ron --scene scenes/materials.ron -o materials.png --size 960x540
echo "Rendered materials.png"
