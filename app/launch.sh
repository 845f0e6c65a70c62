#!/usr/bin/env bash
# Installs what is missing, builds, and opens the workbench: ./app/launch.sh [SCENE] [OPTION...]
# Without a display it renders the scene headless instead and says where the pictures are.
#   --install   only install the packages (those of the test suite too)
#   --build     only install and build
set -euo pipefail
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build_dir=$source_dir/build/release
. "$source_dir/app/packages.sh"

case ${1:-} in -h | --help)
    sed -n '2,5s/^# *//p' "$0"
    echo "Options are those of the program: build/release/bin/lumiscope --help, once it is built."
    exit 0 ;;
esac
if [ "${1:-}" = --install ]; then
    install_packages "${build_packages[@]}" "${test_packages[@]}"
    echo "All packages are installed." >&2
    exit 0
fi
install_packages "${build_packages[@]}"

log=$source_dir/build/launch.log
mkdir -p "$source_dir/build"
echo "Building into $build_dir (the first time takes a few minutes) ..." >&2
if ! (cmake -S "$source_dir" -B "$build_dir" -G Ninja -DCMAKE_BUILD_TYPE=Release &&
      cmake --build "$build_dir" --target lumiscope -j"$(nproc)") >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    echo "The build failed; the whole log is $log" >&2
    exit 1
fi
program=$build_dir/bin/lumiscope
[ "${1:-}" = --build ] && exit 0

if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
    status=0
    "$program" "$@" || status=$?
    [ $status -eq 4 ] || exit $status
    reason="the display \"${DISPLAY:-$WAYLAND_DISPLAY}\" could not be opened"
else
    reason="there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set)"
fi

# The scene is the word that is no option and no option's value; render takes the options as they are.
scene=
options=()
while [ $# -gt 0 ]; do
    case $1 in
        --json | --quiet | --half | -h | --help | --version) options+=("$1") ;;
        --*=*) options+=("$1") ;;
        --*) options+=("$1"); [ $# -gt 1 ] && { options+=("$2"); shift; } ;;
        *) if [ -z "$scene" ]; then scene=$1; else options+=("$1"); fi ;;
    esac
    shift
done
scene=${scene:-atrium}
pictures=$source_dir/build/pictures
name=$(basename "$scene"); name=${name%.*}
mkdir -p "$pictures"
echo "No window: $reason. Rendering \"$scene\" headless instead ..." >&2
rm -f "$pictures/$name.png" "$pictures/$name.exr"
"$program" render "$scene" --size 640x360 --spp 64 --out "$pictures/$name.png" --out "$pictures/$name.exr" "${options[@]}"
echo "Wrote $pictures/$name.png and $pictures/$name.exr (all settings are inside: lumiscope render --replay FILE)." >&2
echo "The workbench itself, drawn without a display: $program view $scene --offscreen --out $pictures" >&2
