#!/usr/bin/env bash
# Installs what is missing, builds everything with warnings as errors, and runs the whole suite; then builds the image
# code and the loaders again with the address and undefined-behaviour sanitizers and feeds them damaged files. By hand, the
# same for any other test:  cmake --preset asan-ubsan && cmake --build --preset asan-ubsan --target test_scene test_session
# Threads, by hand:  cmake --preset tsan && cmake --build --preset tsan --target test_session &&
#   TSAN_OPTIONS=suppressions=$PWD/tests/sanitizers/tsan.supp build/tsan/bin/test_session
# Fuzzing, by hand:  tests/fuzz/run.sh --seconds 600
#   ./tests/run.sh [--quick]     --quick leaves the sanitizers out
set -euo pipefail
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
. "$source_dir/app/packages.sh"
install_packages "${build_packages[@]}" "${test_packages[@]}"
cd "$source_dir"

jobs=$(nproc)
log=$source_dir/build/tests.log
mkdir -p build
build() { # build PRESET TARGET...
    local preset=$1; shift
    echo "Building $preset ..."
    if ! (cmake --preset "$preset" && cmake --build --preset "$preset" -j"$jobs" "$@") >"$log" 2>&1; then
        grep -E -A 12 'error: |FAILED: |CMake Error' "$log" | head -n 80
        echo "The $preset build failed; the whole log is $log"
        exit 1
    fi
}

build release
ctest --test-dir build/release --output-on-failure --timeout 600 -j"$jobs"

if [ "${1:-}" != --quick ]; then
    sanitized="test_base test_params test_image test_robustness"
    # shellcheck disable=SC2086
    build asan-ubsan --target $sanitized
    # Embree and Mesa keep allocations of their own until the process ends.
    export LSAN_OPTIONS=suppressions=$source_dir/tests/sanitizers/lsan.supp:print_suppressions=0
    export UBSAN_OPTIONS=print_stacktrace=1 ASAN_OPTIONS=detect_stack_use_after_return=1
    export LUMISCOPE_MUTATIONS=200
    pattern="^(${sanitized// /|})\$"
    ctest --test-dir build/asan-ubsan --output-on-failure --timeout 900 -R "$pattern" -j"$jobs"
fi
