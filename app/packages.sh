# The Debian 12 packages that Lumiscope needs; sourced by app/launch.sh and tests/run.sh.
# install_packages NAME... installs those that are missing, as root or through sudo, and says so in one line each way.

build_packages=(
    g++ cmake ninja-build ccache pkg-config
    libembree-dev libosd-dev libtinygltf-dev libtinyobjloader-dev libopenexr-dev libpng-dev libstb-dev
    libglfw3-dev libimgui-dev libfreetype-dev libegl-dev libgl-dev libosmesa6-dev libgl1-mesa-dri libegl-mesa0 libglx-mesa0
    libtbb-dev libglm-dev rapidjson-dev nlohmann-json3-dev libcli11-dev libfmt-dev libxxhash-dev
    libdraco-dev libmeshoptimizer-dev
    libgtest-dev
    fonts-inter fonts-jetbrains-mono ffmpeg
)
test_packages=(
    python3 python3-xlib python3-jsonschema xvfb xauth xdotool x11-utils imagemagick git chromium
    embree-tools clang-format
    libopenmpi-dev openmpi-bin
)

install_packages() {
    local missing=() name
    for name in "$@"; do
        dpkg-query -W -f='${Status}' "$name" 2>/dev/null | grep -q '^install ok installed$' || missing+=("$name")
    done
    [ ${#missing[@]} -eq 0 ] && return 0
    local root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || {
            echo "These packages are missing and need root to install; run:" >&2
            echo "    apt-get install ${missing[*]}" >&2
            return 1
        }
        root=(sudo)
    fi
    echo "Installing ${#missing[@]} Debian packages: ${missing[*]}" >&2
    "${root[@]}" apt-get -q update >/dev/null || return 1
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get -q install -y --no-install-recommends "${missing[@]}" >/dev/null || {
        echo "apt-get could not install them; is this Debian 12 with its main archive enabled?" >&2
        return 1
    }
}
