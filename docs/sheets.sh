#!/bin/sh
# Makes the sheets in this folder: frames of timelines, and every kind of light and shadow, side by side.
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

# still NAME PIPELINE SCENE OPTION...: one picture.
still() {
    name="$1" pipeline="$2" scene="$3"
    shift 3
    "$luminaire" render "pipelines/$pipeline.ron" --scene "scenes/$scene.ron" --size 640x360 "$@" -o "$frames/$name.png"
    stills="$stills $frames/$name.png"
}

# Lights: directional, point, spot, rectangle, emissive, the physical sky in the morning and in the evening, all of a scene together.
# Shadows: cascades and what each of them covers, a cube, a spot's map; the filters hardware, pcf3, poisson and pcss.
stills=""
for second in 0 1 2 3 4; do
    still "light$second" pbr light_kinds --time "$second" --set samples=4 --set light_radius=0.05 --set shadow_filter=pcss
done
still morning pbr day --time 1.2 --set sky=physical --set samples=4
still evening pbr day --time 11.4 --set sky=physical --set samples=4
still together pbr shadows --set samples=4
still cascades shadow shadows --camera fence --set light=directional
still covered shadow shadows --camera fence --set light=directional --output cascades
still cube shadow shadows --set light=point --set exposure=1.5
still map shadow shadows --set light=spot --set exposure=2.5
for filter in hardware pcf3 poisson pcss; do
    still "$filter" pbr light_kinds --time 1 --set "shadow_filter=$filter" --set light_radius=0.1 --set local_shadow_texels=256 --set samples=4
done
# shellcheck disable=SC2086 # One word for each image.
"$luminaire" sheet $stills --columns 4 --shrink 2 -o docs/lights_and_shadows.png

# Light from all around: direct light alone in the morning, with the sky's, the evening, materials under a clear sky; a hall, things that
# captured what is around them, mirrors in a captured room, and occlusion alone.
stills=""
still direct pbr day --time 1.2 --set sky=physical --set samples=4
still lit ibl day --time 1.2 --set sky=physical --set samples=4
still dusk ibl day --time 11.4 --set sky=physical --set samples=4
still materials ibl materials --set sky=physical --set samples=4
still hall ibl hall --set samples=4
still scene2 ibl scene2 --set samples=4
still mirrors ibl mirrors --set samples=4
still occlusion occlusion room --set samples=16
# shellcheck disable=SC2086 # One word for each image.
"$luminaire" sheet $stills --columns 4 --shrink 2 -o docs/image_based_light.png
