#include "trace/light_tree_kernels.h"

#include "trace/light_tree_importance.h"

namespace lumi {
namespace {

constexpr int kWidth = LightTreeNode::kWidth;
/// Below this chance of the columns chosen so far the first random number's digits run out, and the second goes on.
constexpr float kDigits = 0x1p-10f;

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

/// Chooses a child by the weights of the walker's node, or the tree at all at the root.
inline Step descend(const LightTreeView& tree, const LightTreePoint& point, const float* weights, float elsewhere,
                    float v, Walker& w, Drawer& drawer, LightTreeChoice& out) {
    const float sum = sumOf(weights);
    if (w.node == 0) {
        const float share = shareOf(sum, elsewhere);
        if (w.u >= share) {
            if (!(elsewhere > 0)) return Step::Ends;
            out.elsewhere = true;
            out.probability = 1 - share;
            out.u = (w.u - share) / (1 - share);
            return Step::Ends;
        }
        w.u /= share;
        w.probability = w.sinceFresh = share;
    }
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

constexpr int kTogether = 64;

LUMI_LANE LightTreePoint pointAt(const LightTreePoints& p, int i) {
    return {p.x[i], p.y[i], p.z[i], p.normalX[i], p.normalY[i], p.normalZ[i], p.facing};
}
LUMI_LANE LightTreePoints pointsFrom(const LightTreePoints& p, int i) {
    return {p.x + i, p.y + i, p.z + i, p.normalX + i, p.normalY + i, p.normalZ + i, p.facing};
}

void pickTogether(const LightTreeView& tree, const LightTreePoints& points, const float* elsewhere, const float* u,
                  const float* v, LightTreeChoice* out, int count) {
    alignas(64) float weights[kTogether][kWidth];
    Walker walkers[kTogether];
    Drawer drawers[kTogether];
    for (int i = 0; i < count; ++i) {
        walkers[i] = {i, 0, u[i], 0, 0, true};
        out[i] = LightTreeChoice();
    }
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
        for (int i = 0; i < count; ++i)
            weigh(tree.nodes[walkers[i].node], pointAt(points, walkers[i].point), weights[i]);
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            Walker w = walkers[i];
            const Step step = descend(tree, pointAt(points, w.point), weights[i], elsewhere[w.point], v[w.point], w,
                                      drawers[drawing], out[w.point]);
            walkers[kept] = w;
            kept += step == Step::Down ? 1 : 0;
            drawing += step == Step::Draws ? 1 : 0;
        }
        count = kept;
        askRanks(before);
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

/// pickTogether() where there are few lights: a light at a time, for all points, without a branch that hangs on the
/// random number.
void pickAmongFew(const LightTreeNode& root, int few, const LightTreePoints& points, const float* elsewhere,
                  const float* u, LightTreeChoice* out, int count) {
    alignas(64) float weights[kWidth][kTogether], chance[kTogether], rest[kTogether];
    alignas(64) uint32_t light[kTogether], outside[kTogether];
    for (int c = 0; c < kWidth; ++c) {
        const Child child = childAt(root, c);
        float* const __restrict column = weights[c];
        if (c >= few) {
            for (int i = 0; i < count; ++i) column[i] = 0;
            continue;
        }
#pragma GCC ivdep
        for (int i = 0; i < count; ++i) column[i] = importanceOf(child, pointAt(points, i));
    }
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
        const float sum = sumOf(weights[0][i], weights[1][i], weights[2][i], weights[3][i], weights[4][i],
                                weights[5][i], weights[6][i], weights[7][i]);
        const float share = shareOf(sum, elsewhere[i]);
        const bool inside = u[i] < share, away = !inside & (elsewhere[i] > 0);
        rest[i] = (u[i] - (inside ? 0.0f : share)) / (inside ? share : away ? 1 - share : 1.0f);
        // The last child whose part of the sum begins before the number.
        const float x = rest[i] * sum;
        float before = 0, own = 0;
        uint32_t chosen = ~0u;
        for (int c = 0; c < LightTreeView::kFew; ++c) {
            const float weight = weights[c][i];
            const bool takes = inside & (weight > 0) & (x >= before);
            chosen = takes ? root.child[c] & ~LightTreeNode::kLight : chosen;
            own = takes ? weight : own;
            before += weight;
        }
        light[i] = chosen;
        outside[i] = away ? 1 : 0;
        chance[i] = inside ? share * (own / sum) : away ? 1 - share : 0.0f;
    }
    for (int i = 0; i < count; ++i) out[i] = {light[i], outside[i] != 0, chance[i], rest[i]};
}

void pick(const LightTreeView& tree, const LightTreePoints& points, const float* elsewhere, const float* u,
          const float* v, LightTreeChoice* out, int count) {
    for (int first = 0; first < count; first += kTogether) {
        const int size = count - first < kTogether ? count - first : kTogether;
        const LightTreePoints some = pointsFrom(points, first);
        if (tree.few > 0 && count >= kWidth)
            pickAmongFew(tree.nodes[0], tree.few, some, elsewhere + first, u + first, out + first, size);
        else pickTogether(tree, some, elsewhere + first, u + first, v + first, out + first, size);
    }
}

float probability(const LightTreeView& tree, const LightTreePoint& point, float elsewhere, const LightTreeWay& way) {
    float product = way.columns > 0 ? 1 : 0;
    uint32_t at = 0;
    for (uint64_t columns = way.columns; columns > LightTreeWay::kEnd; columns >>= LightTreeWay::kBits) {
        const LightTreeNode& node = tree.nodes[at];
        const auto column = static_cast<int>(columns & (kWidth - 1));
        alignas(64) float weights[kWidth];
        weigh(node, point, weights);
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
    weigh(tree.nodes[0], point, weights);
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
