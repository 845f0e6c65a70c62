#pragma once
#include <immintrin.h>

#include <cstdint>

/// A register of floats, as wide as the instruction set that a kernel file is compiled for has them: 4, 8 or 16. For
/// inner loops that keep more values at hand than the compiler holds in registers by itself. Include only from kernel
/// files: everything here has internal linkage, each instruction set compiles its own copy. mulAdd() rounds once where
/// the instruction set can, so that last bits differ between the sets.
namespace lumi {
namespace {

#define LUMI_LANES [[maybe_unused, gnu::always_inline]] inline
#define LUMI_LANES_LAMBDA __attribute__((always_inline))  // where compilers agree that a lambda may have it

#if defined(__AVX512F__) && defined(__AVX512DQ__)

using Lanes = __m512;
constexpr int kLanes = 16;
// The forms with a mask of all lanes: GCC 12 takes what the plain ones leave undefined for a mistake.
constexpr __mmask16 kAllLanes = 0xffff;

LUMI_LANES Lanes lanes(float v) { return _mm512_set1_ps(v); }
LUMI_LANES Lanes loadLanes(const float* p) { return _mm512_loadu_ps(p); }
LUMI_LANES void storeLanes(float* p, Lanes v) { _mm512_storeu_ps(p, v); }
/// a b + c
LUMI_LANES Lanes mulAdd(Lanes a, Lanes b, Lanes c) { return _mm512_fmadd_ps(a, b, c); }
/// c - a b
LUMI_LANES Lanes subMul(Lanes c, Lanes a, Lanes b) { return _mm512_fnmadd_ps(a, b, c); }
/// |a - b|, or 1e30 where that is larger or no number.
LUMI_LANES Lanes distanceOf(Lanes a, Lanes b) { return _mm512_maskz_range_ps(kAllLanes, a - b, lanes(1e30f), 10); }
LUMI_LANES Lanes absolute(Lanes v) { return _mm512_abs_ps(v); }
// Divisions and roots, not their estimates: of these the sets promise an error alone, and makers differ in the bits.
LUMI_LANES Lanes reciprocal(Lanes v) { return lanes(1.0f) / v; }
LUMI_LANES Lanes inverseRoot(Lanes v) { return lanes(1.0f) / _mm512_maskz_sqrt_ps(kAllLanes, v); }
/// `otherwise` where v is NaN; atMost() too.
LUMI_LANES Lanes atLeast(Lanes v, Lanes otherwise) { return _mm512_maskz_max_ps(kAllLanes, v, otherwise); }
LUMI_LANES Lanes atMost(Lanes v, Lanes otherwise) { return _mm512_maskz_min_ps(kAllLanes, v, otherwise); }
LUMI_LANES bool anyAbove(Lanes v, Lanes limit) { return _mm512_cmp_ps_mask(v, limit, _CMP_GT_OQ) != 0; }

/// yes where a > b, else no.
LUMI_LANES Lanes selectAbove(Lanes a, Lanes b, Lanes yes, Lanes no) {
    return _mm512_mask_blend_ps(_mm512_cmp_ps_mask(a, b, _CMP_GT_OQ), no, yes);
}

/// Lanes [from, to) of a register; none where to <= from.
using LaneMask = __mmask16;
LUMI_LANES LaneMask laneMask(int from, int to) {
    return static_cast<LaneMask>(to > from ? ((1u << to) - 1u) & ~((1u << from) - 1u) : 0u);
}
/// The mask's lanes of p[0..kLanes), the others 0; memory of the others is not touched.
LUMI_LANES Lanes loadPart(const float* p, LaneMask mask) { return _mm512_maskz_loadu_ps(mask, p); }
LUMI_LANES void storePart(float* p, LaneMask mask, Lanes v) { _mm512_mask_storeu_ps(p, mask, v); }

#elif defined(__AVX2__) && defined(__FMA__)

using Lanes = __m256;
constexpr int kLanes = 8;

LUMI_LANES Lanes lanes(float v) { return _mm256_set1_ps(v); }
LUMI_LANES Lanes loadLanes(const float* p) { return _mm256_loadu_ps(p); }
LUMI_LANES void storeLanes(float* p, Lanes v) { _mm256_storeu_ps(p, v); }
LUMI_LANES Lanes mulAdd(Lanes a, Lanes b, Lanes c) { return _mm256_fmadd_ps(a, b, c); }
LUMI_LANES Lanes subMul(Lanes c, Lanes a, Lanes b) { return _mm256_fnmadd_ps(a, b, c); }
LUMI_LANES Lanes absolute(Lanes v) { return _mm256_andnot_ps(lanes(-0.0f), v); }
LUMI_LANES Lanes distanceOf(Lanes a, Lanes b) { return _mm256_min_ps(absolute(a - b), lanes(1e30f)); }
LUMI_LANES Lanes reciprocal(Lanes v) { return lanes(1.0f) / v; }
LUMI_LANES Lanes atLeast(Lanes v, Lanes otherwise) { return _mm256_max_ps(v, otherwise); }
LUMI_LANES Lanes atMost(Lanes v, Lanes otherwise) { return _mm256_min_ps(v, otherwise); }
LUMI_LANES Lanes inverseRoot(Lanes v) { return lanes(1.0f) / _mm256_sqrt_ps(v); }
LUMI_LANES bool anyAbove(Lanes v, Lanes limit) { return _mm256_movemask_ps(_mm256_cmp_ps(v, limit, _CMP_GT_OQ)) != 0; }

LUMI_LANES Lanes selectAbove(Lanes a, Lanes b, Lanes yes, Lanes no) {
    return _mm256_blendv_ps(no, yes, _mm256_cmp_ps(a, b, _CMP_GT_OQ));
}

using LaneMask = __m256i;
LUMI_LANES LaneMask laneMask(int from, int to) {
    const __m256i at = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    return _mm256_andnot_si256(_mm256_cmpgt_epi32(_mm256_set1_epi32(from), at),
                               _mm256_cmpgt_epi32(_mm256_set1_epi32(to), at));
}
LUMI_LANES Lanes loadPart(const float* p, LaneMask mask) { return _mm256_maskload_ps(p, mask); }
LUMI_LANES void storePart(float* p, LaneMask mask, Lanes v) { _mm256_maskstore_ps(p, mask, v); }

#else

using Lanes = __m128;
constexpr int kLanes = 4;

LUMI_LANES Lanes lanes(float v) { return _mm_set1_ps(v); }
LUMI_LANES Lanes loadLanes(const float* p) { return _mm_loadu_ps(p); }
LUMI_LANES void storeLanes(float* p, Lanes v) { _mm_storeu_ps(p, v); }
LUMI_LANES Lanes mulAdd(Lanes a, Lanes b, Lanes c) { return a * b + c; }
LUMI_LANES Lanes subMul(Lanes c, Lanes a, Lanes b) { return c - a * b; }
LUMI_LANES Lanes absolute(Lanes v) { return _mm_andnot_ps(lanes(-0.0f), v); }
LUMI_LANES Lanes distanceOf(Lanes a, Lanes b) { return _mm_min_ps(absolute(a - b), lanes(1e30f)); }
LUMI_LANES Lanes reciprocal(Lanes v) { return lanes(1.0f) / v; }
LUMI_LANES Lanes atLeast(Lanes v, Lanes otherwise) { return _mm_max_ps(v, otherwise); }
LUMI_LANES Lanes atMost(Lanes v, Lanes otherwise) { return _mm_min_ps(v, otherwise); }
LUMI_LANES Lanes inverseRoot(Lanes v) { return lanes(1.0f) / _mm_sqrt_ps(v); }
LUMI_LANES bool anyAbove(Lanes v, Lanes limit) { return _mm_movemask_ps(_mm_cmpgt_ps(v, limit)) != 0; }
LUMI_LANES Lanes selectAbove(Lanes a, Lanes b, Lanes yes, Lanes no) {
    const Lanes mask = _mm_cmpgt_ps(a, b);
    return _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no));
}

struct LaneMask {
    int from, to;
};
LUMI_LANES LaneMask laneMask(int from, int to) { return {from, to}; }
LUMI_LANES Lanes loadPart(const float* p, LaneMask mask) {
    alignas(16) float part[kLanes] = {0, 0, 0, 0};
    for (int i = mask.from; i < mask.to; ++i) part[i] = p[i];
    return _mm_load_ps(part);
}
LUMI_LANES void storePart(float* p, LaneMask mask, Lanes v) {
    alignas(16) float part[kLanes];
    _mm_store_ps(part, v);
    for (int i = mask.from; i < mask.to; ++i) p[i] = part[i];
}

#endif

using IntLanes = int32_t __attribute__((vector_size(sizeof(Lanes))));

/// x[i] to 2^x[i], for x in [-126, 127], below that 0 or a denormal; relative error below 1e-5, which weights do not
/// feel. NaN gives what -127 does, all but 0, so that a weight made of it drops its tap. Several at once, step by step:
/// each step waits for the one before, and processors look only so far ahead.
template <int Count>
LUMI_LANES void weightExp2(Lanes (&x)[Count]) {
    Lanes f[Count], p[Count];
    const auto forAll = [](auto step) LUMI_LANES_LAMBDA {
        for (int i = 0; i < Count; ++i) step(i);
    };
    forAll([&](int i) { x[i] = atLeast(x[i], lanes(-127.0f)); });
#if defined(__AVX512F__) && defined(__AVX512DQ__)
    // f is x - floor(x); interpolant of (2^f - 1) / f in the Chebyshev nodes of [0, 1], degree 3.
    forAll([&](int i) { f[i] = _mm512_maskz_reduce_ps(kAllLanes, x[i], _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC); });
    forAll([&](int i) { p[i] = mulAdd(lanes(0.0127631139f), f[i], lanes(0.0534410293f)); });
    forAll([&](int i) { p[i] = mulAdd(p[i], f[i], lanes(0.240647048f)); });
    forAll([&](int i) { p[i] = mulAdd(p[i], f[i], lanes(0.693133993f)); });
    forAll([&](int i) { p[i] = mulAdd(p[i], f[i], lanes(1.0f)); });
    forAll([&](int i) { x[i] = _mm512_maskz_scalef_ps(kAllLanes, p[i], x[i]); });
#else
    const Lanes magic = lanes(12582912.0f);  // 1.5 * 2^23: a sum's low bits become the nearest integer
    Lanes shifted[Count];
    forAll([&](int i) { shifted[i] = x[i] + magic; });
    forAll([&](int i) { f[i] = x[i] - (shifted[i] - magic); });
    // The same in [-0.5, 0.5].
    forAll([&](int i) { p[i] = mulAdd(lanes(0.00965671029f), f[i], lanes(0.0558382829f)); });
    forAll([&](int i) { p[i] = mulAdd(p[i], f[i], lanes(0.240225301f)); });
    forAll([&](int i) { p[i] = mulAdd(p[i], f[i], lanes(0.693136734f)); });
    forAll([&](int i) { p[i] = mulAdd(p[i], f[i], lanes(1.0f)); });
    forAll([&](int i) { x[i] = (Lanes)((IntLanes)p[i] + ((IntLanes)shifted[i] << 23)); });
#endif
}

/// log2(x) for x in (0, 1], absolute error below 7e-7, without a division; above 1 and for NaN 0, tiny x gives about
/// -126.
LUMI_LANES Lanes log2OfCosine(Lanes x) {
    x = atMost(atLeast(x, lanes(1.17549435e-38f)), lanes(1.0f));
    // the mantissa in [sqrt(1/2), sqrt(2)): 0x3f3504f3 is sqrt(1/2)
    const IntLanes exponent = ((IntLanes)x - 0x3f3504f3) >> 23;
    const Lanes t = (Lanes)((IntLanes)x - (exponent << 23)) - lanes(1.0f);
    // Interpolant of log2(1 + t)/t in the Chebyshev nodes, degree 6.
    Lanes p = mulAdd(lanes(0.16818659f), t, lanes(-0.26796387f));
    p = mulAdd(p, t, lanes(0.29611956f));
    p = mulAdd(p, t, lanes(-0.35952446f));
    p = mulAdd(p, t, lanes(0.48061313f));
    p = mulAdd(p, t, lanes(-0.72136018f));
    p = mulAdd(p, t, lanes(1.4426965f));
    return mulAdd(p, t, __builtin_convertvector(exponent, Lanes));
}

}  // namespace
}  // namespace lumi
