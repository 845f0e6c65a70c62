#!/usr/bin/env bash
# Renders every glTF, OBJ cage and environment of the shared assets small and tiles the pictures, labelled, so that one
# look shows whether all of them open and mean what their authors meant.
#   tests/contact_sheet.sh OUT [--size WxH] [--spp N] [--filter REGEX] [--program FILE]
# OUT gets gltf.png, cages.png, environments.png, the single pictures, and messages.txt with every warning and refusal.
# Assets are looked for in $LUMISCOPE_ASSETS, else ../shared/assets beside the checkout. Exit code 1 if a file is refused.
set -euo pipefail
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
assets=${LUMISCOPE_ASSETS:-$source_dir/../shared/assets}
program=$source_dir/build/release/bin/lumiscope
size=200x150 spp=32 filter=. out=
while [ $# -gt 0 ]; do
    case $1 in
        --size) size=$2; shift 2 ;;
        --spp) spp=$2; shift 2 ;;
        --filter) filter=$2; shift 2 ;;
        --program) program=$2; shift 2 ;;
        -*) sed -n '2,6s/^# *//p' "$0" >&2; exit 2 ;;
        *) out=$1; shift ;;
    esac
done
[ -n "$out" ] || { sed -n '2,6s/^# *//p' "$0" >&2; exit 2; }
[ -d "$assets" ] || { echo "no shared assets at $assets" >&2; exit 2; }
assets=$(cd "$assets" && pwd)
mkdir -p "$out"
out=$(cd "$out" && pwd)
: >"$out/messages.txt"
rm -f "$out"/{gltf,cages,environments}/*.png
refused=0

# render SHEET LABEL SCENE OPTION...: one picture, 0.4 s into the file's animation.
render() {
    local sheet=$1 label=$2 scene=$3; shift 3
    grep -qE "$filter" <<<"$label" || return 0
    mkdir -p "$out/$sheet"
    local picture=$out/$sheet/${label//\// }.png messages
    rm -f "$picture"
    if ! messages=$("$program" render "$scene" --size "$size" --spp "$spp" --frames 24..25 --progress never \
                    --out "$picture" "$@" 2>&1 >/dev/null); then
        refused=$((refused + 1))
        convert -size "$size" xc:darkred "$picture"
        echo "$label: REFUSED" >>"$out/messages.txt"
    fi
    # The report of a good run says nothing about the file.
    grep -vE '^Wrote |^[0-9]+ frames?, ' <<<"$messages" | sed "/^\$/d; s|^|$label: |" >>"$out/messages.txt" || true
}

tile() { # tile SHEET
    local pictures=("$out/$1"/*.png)
    [ -e "${pictures[0]}" ] || return 0
    local font=()
    command -v fc-match >/dev/null && font=(-font "$(fc-match -f '%{file}' sans)")
    montage "${font[@]}" -pointsize 9 -label '%t' "${pictures[@]}" -tile 8x -geometry '+4+2' \
        -background '#202020' -fill white "$out/$1.png"
    echo "$out/$1.png: ${#pictures[@]} pictures"
}

while IFS= read -r file; do
    name=${file#"$assets/gltf/"}
    name=${name%.*}
    [ "${name%/*}" != "${name##*/}" ] || name=${name##*/}
    render gltf "$name" "$file"
done < <(find "$assets/gltf" -name '*.gltf' -o -name '*.glb' | sort)

# A cage is shown as the surface that it says, else as Catmull-Clark's, with its texture if it has one, under a soft sky.
while IFS= read -r file; do
    name=$(basename "$file" .obj)
    material='"base-color": [0.55, 0.6, 0.68], "roughness": 0.35'
    texture=${file%/*}/${name%%_*}_texture.png
    scheme=catmull-clark
    ! grep -q '^# scheme:' "$file" || scheme=auto
    [ ! -e "$texture" ] || material="\"base-color-texture\": \"$texture\", \"roughness\": 0.5"
    cat >"$out/cage.json" <<JSON
{"version": 1, "assets": {"cage": {"obj": "$file", "subdivision": "$scheme", "rate": 6}},
 "materials": {"clay": {$material}}, "instances": [{"name": "cage", "asset": "cage", "material": "clay"}],
 "environment": {"file": "$assets/env/venice_sunset_1k.hdr"}}
JSON
    render cages "$name" "$out/cage.json"
done < <(find "$assets/subdiv" -name '*.obj' -not -path '*/baseline/*' | sort)
rm -f "$out/cage.json"

for file in "$assets"/env/*.hdr; do
    render environments "$(basename "$file" .hdr)" "$file"
done

for sheet in gltf cages environments; do tile "$sheet"; done
echo "$out/messages.txt: $(wc -l <"$out/messages.txt") lines, $refused files refused"
[ "$refused" -eq 0 ]
