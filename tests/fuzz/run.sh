#!/usr/bin/env bash
# Builds the libFuzzer targets with clang, the address and the undefined-behaviour sanitizer, and runs each for a while on
# one core, from good files and what was found in earlier runs. Findings end it with code 1.
#   tests/fuzz/run.sh [--seconds N] [--corpus DIR] [TARGET...]      60 s each; targets: gltf glb obj mtl json path ...
set -euo pipefail
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
seconds=60 corpus=$source_dir/build/fuzz/corpus targets=()
while [ $# -gt 0 ]; do
    case $1 in
        --seconds) seconds=$2; shift 2 ;;
        --corpus) corpus=$2; shift 2 ;;
        -*) sed -n '2,4s/^# *//p' "$0" >&2; exit 2 ;;
        *) targets+=("$1"); shift ;;
    esac
done
[ ${#targets[@]} -gt 0 ] || targets=(gltf glb obj mtl json path exr hdr png jpg cage study state part)
cd "$source_dir"
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target "${targets[@]/#/fuzz_}"

# Embree and Mesa keep allocations of their own until the process ends.
export LSAN_OPTIONS=suppressions=$source_dir/tests/sanitizers/lsan.supp:print_suppressions=0

# Good files: what test_robustness damages, the shipped scenes and studies, and the assets if they are here.
robustness=build/release/bin/test_robustness
seeds=$corpus/seeds
mkdir -p "$seeds"
if [ -x "$robustness" ] && [ -z "$(ls -A "$seeds")" ]; then
    LUMISCOPE_SEEDS=$seeds LUMISCOPE_MUTATIONS=20 "$robustness" >/dev/null || true
fi
assets=${LUMISCOPE_ASSETS:-$source_dir/../shared/assets}
good() { # good KIND: its good files, small ones
    case $1 in
        study) ls scenes/studies/*.json ;;
        json) ls scenes/cornell.json ;;
        cage) find "$assets/subdiv" -name 'catmark_*.obj' -size -8k 2>/dev/null ;;
        jpg) find "$assets/gltf" \( -name '*.jpg' -o -name '*.jpeg' \) -size -64k 2>/dev/null ;;
        *) find "$seeds" "$assets/gltf" -name "*.$1" -size -64k 2>/dev/null ;;
    esac | { grep -v schema || true; } | head -n 40
}

failed=0
for target in "${targets[@]}"; do
    own=$corpus/$target
    mkdir -p "$own"
    good "$target" | while IFS= read -r file; do cp -n "$file" "$own/$(basename "$file")"; done
    if [ -d "tests/fuzz/seeds/$target" ]; then cp -n "tests/fuzz/seeds/$target"/* "$own"; fi
    # Mesa is not in it; what Embree, OpenSubdiv and tinygltf allocate counts.
    if build/fuzz/bin/fuzz_"$target" "$own" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=3000 -max_len=65536 \
        -artifact_prefix="$corpus/$target-" >"$corpus/$target.log" 2>&1; then
        result="no finding"
    else
        result="FINDING, see $corpus/$target.log" failed=1
    fi
    echo "$target: $(grep -oE 'Done [0-9]+ runs in [0-9]+ second' "$corpus/$target.log" || true)," \
         "peak $(grep -oE 'rss: [0-9]+Mb' "$corpus/$target.log" | tail -n 1), $result"
done
rm -rf /dev/shm/lumiscope-fuzz-*
exit $failed
