#include "trace/light_tree_kernels.h"

#include <cmath>

namespace lumi {
namespace {

constexpr int kWidth = LightTreeNode::kWidth;
constexpr float kLeastShare = 0.1f;
/// Below this chance of the columns chosen so far the first random number's digits run out, and the second goes on.
constexpr float kDigits = 0x1p-10f;

#define LUMI_TREE_LANE [[maybe_unused, gnu::always_inline]] inline

LUMI_TREE_LANE float positive(float x) { return x > 0 ? x : 0.0f; }

/// One column of a node.
struct Column {
    float x, y, z, radius, axisX, axisY, axisZ, cosSpread, sinSpread, cosReach, bothSides, intensity;
};
LUMI_TREE_LANE Column columnAt(const LightTreeNode& n, int i) {
    return {n.x[i],     n.y[i],         n.z[i],         n.radius[i],   n.axisX[i],     n.axisY[i],
            n.axisZ[i], n.cosSpread[i], n.sinSpread[i], n.cosReach[i], n.bothSides[i], n.intensity[i]};
}

/// Angles are kept as sine and cosine: cos(max(0, a - b)) is cos a cos b + sin a sin b, or 1 where a <= b.
LUMI_TREE_LANE float importanceOf(const Column& c, const LightTreePoint& p) {
    // From the centre to the point; the sphere's half-angle as seen from there.
    const float dx = p.x - c.x, dy = p.y - c.y, dz = p.z - c.z;
    const float distance2 = dx * dx + dy * dy + dz * dz;
    const float radius2 = c.radius * c.radius;
    const bool inside = distance2 <= radius2;
    // Directions from inside do not matter, and it is never nearer than the sphere.
    const float nearest2 = inside ? radius2 : distance2;
    const float inverse = 1.0f / std::sqrt(nearest2 > 1e-30f ? nearest2 : 1e-30f);
    const float sinBall = c.radius * inverse;
    const float cosBall = std::sqrt(positive(1 - sinBall * sinBall));

    // Between what a light faces and the direction to the point: the least that it can be.
    const float along = (c.axisX * dx + c.axisY * dy + c.axisZ * dz) * inverse;
    const float cosAxis = c.bothSides > 0 ? std::fabs(along) : along;
    const float sinAxis = std::sqrt(positive(1 - cosAxis * cosAxis));
    const bool faced = cosAxis >= c.cosSpread;
    const float cosRest = faced ? 1.0f : cosAxis * c.cosSpread + sinAxis * c.sinSpread;
    const float sinRest = faced ? 0.0f : sinAxis * c.cosSpread - cosAxis * c.sinSpread;
    const float cosLeaving = inside || cosRest >= cosBall ? 1.0f : cosRest * cosBall + positive(sinRest) * sinBall;

    // Between the point's normal and the direction to a light: the least that it can be.
    const float toLight = -(p.normalX * dx + p.normalY * dy + p.normalZ * dz) * inverse;
    const float cosNormal = p.facing == 2 ? std::fabs(toLight) : toLight;
    const float sinNormal = std::sqrt(positive(1 - cosNormal * cosNormal));
    const float bounded = cosNormal >= cosBall ? 1.0f : cosNormal * cosBall + sinNormal * sinBall;
    const float cosArriving = inside || p.facing == 0 ? 1.0f : positive(bounded);

    const float value = c.intensity * cosLeaving * cosArriving * (inverse * inverse);
    return cosLeaving > c.cosReach && c.intensity > 0 ? value : 0.0f;
}

/// Of the eight columns to one point.
inline void importance(const LightTreeNode& node, const LightTreePoint& p, float* __restrict result) {
    for (int i = 0; i < kWidth; ++i) result[i] = importanceOf(columnAt(node, i), p);
}

constexpr int kTogether = 64;
/// Of a node's columns to many points.
using Columns = float[kWidth][kTogether];

inline LightTreePoint pointAt(const LightTreePoints& p, int i) {
    return {p.x[i], p.y[i], p.z[i], p.normalX[i], p.normalY[i], p.normalZ[i], p.facing};
}

LUMI_TREE_LANE LightTreePoints pointsFrom(const LightTreePoints& p, int i) {
    return {p.x + i, p.y + i, p.z + i, p.normalX + i, p.normalY + i, p.normalZ + i, p.facing};
}

void importances(const LightTreeNode& node, const LightTreePoints& points, int count, Columns& result) {
    for (int c = 0; c < kWidth; ++c) {
        const Column column = columnAt(node, c);
        if (!(column.intensity > 0)) {
            for (int i = 0; i < count; ++i) result[c][i] = 0;
            continue;
        }
#pragma GCC ivdep
        for (int i = 0; i < count; ++i) result[c][i] = importanceOf(column, pointAt(points, i));
    }
}

LUMI_TREE_LANE float sumOf(float a, float b, float c, float d, float e, float f, float g, float h) {
    return ((a + b) + (c + d)) + ((e + f) + (g + h));
}
inline float sumOf(const float* v) { return sumOf(v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7]); }

/// Share of the tree in the choice, by what it weighs beside the rest.
LUMI_TREE_LANE float shareOf(float tree, float elsewhere) {
    const bool both = tree > 0 && elsewhere > 0;
    const float share = tree / (both ? tree + elsewhere : 1.0f);
    const float kept = share < kLeastShare ? kLeastShare : share > 1 - kLeastShare ? 1 - kLeastShare : share;
    return both ? kept : tree > 0 ? 1.0f : 0.0f;
}

/// Column of the running sum that holds `x`, never an empty one; `x` becomes its part of it in [0, 1). Some weight is
/// positive.
inline int columnOf(const float* weights, float& x) {
    float before[kWidth + 1];
    before[0] = 0;
    for (int i = 0; i < kWidth; ++i) before[i + 1] = before[i] + weights[i];
    int chosen = 0;
    for (int i = 1; i < kWidth; ++i) chosen += x >= before[i] ? 1 : 0;
    // Rounding may leave x past the last that is not empty.
    while (chosen > 0 && !(weights[chosen] > 0)) --chosen;
    while (chosen < kWidth - 1 && !(weights[chosen] > 0)) ++chosen;
    const float part = (x - before[chosen]) / weights[chosen];
    x = part < 0 ? 0.0f : part < 0x1.fffffep-1f ? part : 0x1.fffffep-1f;
    return chosen;
}

/// Are the lights below that child far enough to be as one?
inline bool isFar(const LightTreeNode& node, int column, const LightTreePoint& p) {
    const float dx = p.x - node.x[column], dy = p.y - node.y[column], dz = p.z - node.z[column];
    return dx * dx + dy * dy + dz * dz > node.far2[column];
}

/// Where in the order a light of a group likely is that holds the part `u` of its intensity.
inline uint32_t guessIn(const LightTreeGroup& group, float u) {
    const uint32_t count = group.end - group.begin, offset = static_cast<uint32_t>(u * static_cast<float>(count));
    return group.begin + (offset < count ? offset : count - 1);
}

/// Draws one of a group by intensity; `chance` is its share. Lights of a group are mostly alike, and the guess is near.
inline uint32_t drawFrom(const LightTreeView& tree, const LightTreeGroup& group, float& u, float& chance) {
    const LightTreeRank* ranks = tree.ranks;
    const double x = group.before + double(u) * group.intensity;
    uint32_t at = guessIn(group, u), low = group.begin, high = group.end;  // of low <= x < of high
    while (high - low > 1 && (ranks[at].before > x || ranks[at + 1].before <= x)) {
        (ranks[at].before <= x ? low : high) = ranks[at].before <= x ? at + 1 : at;
        at = low + (high - low) / 2;
    }
    if (high - low <= 1) at = low < group.end ? low : group.end - 1;
    const double own = ranks[at + 1].before - ranks[at].before;
    chance = static_cast<float>(own / group.intensity);
    const float rest = own > 0 ? static_cast<float>((x - ranks[at].before) / own) : 0.0f;
    u = rest < 0x1.fffffep-1f ? rest : 0x1.fffffep-1f;
    return ranks[at].light;
}

/// A point on its way down the tree.
struct Walker {
    int point;
    uint32_t node;  ///< to be looked at next
    float u, probability, sinceFresh;
    bool fresh;  ///< the second random number is unused
};

/// A point that has come to a group.
struct Drawer {
    int point;
    const LightTreeGroup* group;
    float u, probability;
};

inline void prefetchNode(const LightTreeView& tree, uint32_t node) {
    const char* bytes = reinterpret_cast<const char*>(&tree.nodes[node]);
    for (size_t line = 0; line < sizeof(LightTreeNode); line += 64) __builtin_prefetch(bytes + line);
}

enum class Step { Ends, Down, Draws };

/// Chooses a child by the weights of the walker's node.
inline Step descend(const LightTreeView& tree, const LightTreePoint& point, const float* weights, float v, Walker& w,
                    Drawer& drawer, LightTreeChoice& out) {
    const float sum = sumOf(weights);
    if (!(sum > 0)) return Step::Ends;
    if (w.fresh && w.sinceFresh < kDigits) w.u = v, w.fresh = false;
    w.u *= sum;
    const int column = columnOf(weights, w.u);
    const float chance = weights[column] / sum;
    w.probability *= chance;
    w.sinceFresh *= chance;
    const LightTreeNode& node = tree.nodes[w.node];
    const uint32_t child = node.child[column];
    if (child & LightTreeNode::kLight) {
        out.light = child & ~LightTreeNode::kLight;
        out.probability = w.probability;
        out.u = w.u;
        return Step::Ends;
    }
    if (isFar(node, column, point)) {
        const LightTreeGroup& group = tree.groups[w.node * kWidth + static_cast<uint32_t>(column)];
        __builtin_prefetch(&group);
        drawer = {w.point, &group, w.fresh && w.sinceFresh < 4 * kDigits ? v : w.u, w.probability};
        return Step::Draws;
    }
    w.node = child;
    prefetchNode(tree, child);
    return Step::Down;
}

/// The tree, by the weights of its root's columns, or what is elsewhere: no branch hangs on the random numbers. Returns
/// how many points go down the tree, first in `walkers`.
int enter(const Columns& root, const float* elsewhere, const float* u, LightTreeChoice* out, Walker* walkers,
          int count) {
    alignas(64) float sums[kTogether], shares[kTogether], rests[kTogether];
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        sums[i] = sumOf(root[0][i], root[1][i], root[2][i], root[3][i], root[4][i], root[5][i], root[6][i], root[7][i]);
        const float share = shareOf(sums[i], elsewhere[i]);
        const bool inside = u[i] < share;
        shares[i] = share;
        rests[i] = inside ? u[i] / (inside ? share : 1.0f) : (u[i] - share) / (inside ? 1.0f : 1 - share);
    }
    int entered = 0;
    for (int i = 0; i < count; ++i) {
        const bool inside = u[i] < shares[i], outside = !inside & (elsewhere[i] > 0);
        out[i] = {~0u, outside, outside ? 1 - shares[i] : 0.0f, outside ? rests[i] : 0.0f};
        walkers[entered] = {i, 0, rests[i], shares[i], shares[i], true};
        entered += inside & (sums[i] > 0) ? 1 : 0;
    }
    return entered;
}

void pickTogether(const LightTreeView& tree, const LightTreePoints& points, const float* elsewhere, const float* u,
                  const float* v, LightTreeChoice* out, int count) {
    alignas(64) Columns root;
    alignas(64) float weights[kTogether][kWidth];
    Walker walkers[kTogether];
    Drawer drawers[kTogether];
    importances(tree.nodes[0], points, count, root);
    count = enter(root, elsewhere, u, out, walkers, count);
    for (int i = 0; i < count; ++i)
        for (int c = 0; c < kWidth; ++c) weights[i][c] = root[c][walkers[i].point];
    int drawing = 0, asked = 0;
    // What a drawer reads first is asked for a round after its group.
    const auto askRanks = [&](int end) {
        for (; asked < end; ++asked) {
            const LightTreeRank* const rank = &tree.ranks[guessIn(*drawers[asked].group, drawers[asked].u)];
            __builtin_prefetch(rank), __builtin_prefetch(rank + 1);
        }
    };
    while (count > 0) {
        const int before = drawing;
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            Walker w = walkers[i];
            const Step step =
                descend(tree, pointAt(points, w.point), weights[i], v[w.point], w, drawers[drawing], out[w.point]);
            walkers[kept] = w;
            kept += step == Step::Down ? 1 : 0;
            drawing += step == Step::Draws ? 1 : 0;
        }
        count = kept;
        askRanks(before);
        for (int i = 0; i < count; ++i)
            importance(tree.nodes[walkers[i].node], pointAt(points, walkers[i].point), weights[i]);
    }
    askRanks(drawing);
    for (int i = 0; i < drawing; ++i) {
        Drawer& drawer = drawers[i];
        LightTreeChoice& choice = out[drawer.point];
        float inGroup = 1;
        choice.light = drawFrom(tree, *drawer.group, drawer.u, inGroup);
        choice.probability = drawer.probability * inGroup;
        choice.u = drawer.u;
    }
}

void pick(const LightTreeView& tree, const LightTreePoints& points, const float* elsewhere, const float* u,
          const float* v, LightTreeChoice* out, int count) {
    for (int first = 0; first < count; first += kTogether)
        pickTogether(tree, pointsFrom(points, first), elsewhere + first, u + first, v + first, out + first,
                     count - first < kTogether ? count - first : kTogether);
}

float probability(const LightTreeView& tree, const LightTreePoint& point, float elsewhere, const LightTreeWay& way) {
    float product = way.columns > 0 ? 1 : 0;
    uint32_t at = 0;
    for (uint64_t columns = way.columns; columns > LightTreeWay::kEnd; columns >>= LightTreeWay::kBits) {
        const LightTreeNode& node = tree.nodes[at];
        const auto column = static_cast<int>(columns & (kWidth - 1));
        alignas(64) float weights[kWidth];
        importance(node, point, weights);
        const float sum = sumOf(weights);
        if (!(weights[column] > 0)) return 0;
        if (at == 0) product *= shareOf(sum, elsewhere);
        product *= weights[column] / sum;
        const bool last = columns >> LightTreeWay::kBits == LightTreeWay::kEnd;
        if (!last && isFar(node, column, point)) {
            const LightTreeGroup& group = tree.groups[at * kWidth + static_cast<uint32_t>(column)];
            return product * static_cast<float>(way.intensity / group.intensity);
        }
        at = node.child[column];
    }
    return product;
}

float share(const LightTreeView& tree, const LightTreePoint& point, float elsewhere) {
    alignas(64) float weights[kWidth];
    importance(tree.nodes[0], point, weights);
    return shareOf(sumOf(weights), elsewhere);
}

}  // namespace

namespace LUMI_ISA {
const LightTreeKernels& lightTreeTable() {
    static const LightTreeKernels table{pick, probability, share};
    return table;
}
}  // namespace LUMI_ISA

}  // namespace lumi
