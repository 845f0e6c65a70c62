#include "trace/light_tree.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <memory>
#include <mutex>

#include "base/error.h"
#include "base/parallel.h"
#include "math/hash.h"

namespace lumi {
namespace {

constexpr int kWidth = LightTreeNode::kWidth;
constexpr int kBins = 12;
/// Ranges of fewer lights are built by one thread.
constexpr size_t kAlone = 4096;
/// Lights that are taken as one from afar: at most so many, from so many of their group's radii on, if their directions
/// lie within this cone.
constexpr uint32_t kMostInGroup = 4096;
constexpr float kFarRadii = 4, kGroupSpread = 0.8f;
/// A light of a group is drawn by the difference of two sums, which far brighter lights before it may leave without
/// digits: it may be off by this part.
constexpr double kMostRounding = 0.1;

/// A range of the order of lights, with its bounds.
struct Range {
    uint32_t begin = 0, end = 0;
    LightBounds bounds;
    uint32_t size() const { return end - begin; }
};

/// Nodes that many threads add, in blocks that stay where they are.
class NodePool {
public:
    /// For at most `count` nodes.
    explicit NodePool(size_t count) : blocks_(count / kBlock + 1) {}

    uint32_t add() {
        const uint32_t index = count_++;
        Block& block = blocks_[index / kBlock];
        std::call_once(block.made, [&] { block.nodes = std::make_unique_for_overwrite<LightTreeNode[]>(kBlock); });
        return index;
    }
    LightTreeNode& operator[](uint32_t index) { return blocks_[index / kBlock].nodes[index % kBlock]; }
    size_t size() const { return count_; }

private:
    static constexpr uint32_t kBlock = 1024;
    struct Block {
        std::once_flag made;
        std::unique_ptr<LightTreeNode[]> nodes;
    };
    std::vector<Block> blocks_;
    std::atomic<uint32_t> count_{0};
};

class Builder {
public:
    Builder(std::span<const LightBounds> lights, std::stop_token stop)
        : lights_(lights), stop_(std::move(stop)), order_(lights.size()), nodes_(lights.size()) {
        for (uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    }

    /// Makes the subtree over `range`, whose root is `depth` below that of the tree. Returns the root.
    uint32_t build(const Range& range, uint32_t depth = 0) {
        if (stop_.stop_requested()) throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
        std::array<Range, kWidth> children;
        // Cuts by cost may be as uneven as they like until the levels that are left just suffice for even ones.
        const int count = divide(range, children, depth + levelsOf(range.size()) >= LightTreeWay::kMost);
        const uint32_t self = nodes_.add();
        LightTreeNode& node = nodes_[self];
        node = emptyNode();
        const auto buildChild = [&](int64_t i) {
            const int c = static_cast<int>(i);
            const Range& child = children[static_cast<size_t>(c)];
            setColumn(node, c, child.bounds);
            node.child[c] = child.size() == 1 ? LightTreeNode::kLight | order_[child.begin] : build(child, depth + 1);
        };
        if (range.size() > kAlone) parallelFor(count, buildChild);
        else
            for (int c = 0; c < count; ++c) buildChild(c);
        return self;
    }

    std::vector<uint32_t> takeOrder() { return std::move(order_); }

    /// The nodes level by level: the upper levels, which every walk down meets, lie together.
    std::vector<LightTreeNode> takeNodes(uint32_t root) {
        std::vector<uint32_t> sources{root};
        std::vector<LightTreeNode> sorted;
        sources.reserve(nodes_.size()), sorted.reserve(nodes_.size());
        for (size_t i = 0; i < sources.size(); ++i) {
            sorted.push_back(nodes_[sources[i]]);
            for (uint32_t& child : sorted.back().child) {
                if (child & LightTreeNode::kLight) continue;
                sources.push_back(child);
                child = static_cast<uint32_t>(sources.size() - 1);
            }
        }
        return sorted;
    }

    Range whole() const {
        Range range{0, static_cast<uint32_t>(order_.size()), {}};
        range.bounds = boundsOf(range.begin, range.end);
        return range;
    }

private:
    /// Levels of a tree of even cuts.
    static uint32_t levelsOf(uint32_t size) {
        uint32_t levels = 1;
        for (uint64_t held = kWidth; held < size; held *= kWidth) ++levels;
        return levels;
    }
    static LightTreeNode emptyNode() {
        LightTreeNode node{};
        for (int c = 0; c < kWidth; ++c)
            node.axisZ[c] = 1, node.child[c] = LightTreeNode::kLight, node.far2[c] = kInfinity;
        return node;
    }
    static void setColumn(LightTreeNode& node, int c, const LightBounds& b) {
        const Vec3 centre = b.box.centre();
        node.x[c] = centre.x, node.y[c] = centre.y, node.z[c] = centre.z;
        // A little more than the box: rounding must not make a light vanish that shines along its own plane.
        node.radius[c] = b.box.radius() * 1.0001f + 1e-6f * maxComponent(glm::abs(centre));
        node.axisX[c] = b.axis.x, node.axisY[c] = b.axis.y, node.axisZ[c] = b.axis.z;
        node.cosSpread[c] = b.cosSpread, node.cosReach[c] = b.cosReach;
        node.sinSpread[c] = std::sqrt(std::max(0.0f, 1 - b.cosSpread * b.cosSpread));
        node.bothSides[c] = b.bothSides ? 1.0f : 0.0f;
        node.intensity[c] = b.intensity;
    }
    LightBounds boundsOf(uint32_t begin, uint32_t end) const {
        LightBounds bounds = lights_[order_[begin]];
        for (uint32_t i = begin + 1; i < end; ++i) bounds = unite(bounds, lights_[order_[i]]);
        return bounds;
    }

    /// Cuts `range` into up to eight, always the costliest first, or if `even` the largest, and into halves. Returns
    /// how many.
    int divide(const Range& range, std::array<Range, kWidth>& parts, bool even) {
        parts[0] = range;
        int count = 1;
        // Near the leaves as many as one node holds stay together: nodes of two or three lights are mostly empty.
        const uint32_t least = range.size() > kWidth && range.size() <= kWidth * kWidth ? kWidth : 1;
        while (count < kWidth) {
            int worst = -1;
            float cost = -1;
            for (int i = 0; i < count; ++i) {
                const Range& part = parts[static_cast<size_t>(i)];
                const float own = part.size() <= least ? -1
                                  : even               ? static_cast<float>(part.size())
                                                       : costOf(part.bounds);
                if (own > cost) worst = i, cost = own;
            }
            if (worst < 0) break;
            parts[static_cast<size_t>(count)] = split(parts[static_cast<size_t>(worst)], even);
            ++count;
        }
        return count;
    }

    struct Cut {
        float cost = kInfinity;
        int axis = -1, bin = 0;
        LightBounds left, right;
    };

    /// Shortens `range` to the left part of its best cut, or its first half, and returns the right part.
    Range split(Range& range, bool even) {
        Bounds3 centres;
        for (uint32_t i = range.begin; i < range.end; ++i) centres.extend(lights_[order_[i]].box.centre());
        const Cut best = even ? Cut() : bestCut(range, centres);
        const auto begin = order_.begin() + range.begin, end = order_.begin() + range.end;
        auto middle = begin;
        if (best.axis >= 0)
            middle = std::partition(begin, end, [&](uint32_t light) {
                return binOf(lights_[light].box.centre()[best.axis], centres, best.axis) < best.bin;
            });
        if (middle == begin || middle == end) {
            // In halves: asked for, or all are in one place.
            middle = begin + range.size() / 2;
            const auto at = static_cast<uint32_t>(middle - order_.begin());
            const Range right{at, range.end, boundsOf(at, range.end)};
            range = {range.begin, at, boundsOf(range.begin, at)};
            return right;
        }
        const auto at = static_cast<uint32_t>(middle - order_.begin());
        const Range right{at, range.end, best.right};
        range = {range.begin, at, best.left};
        return right;
    }

    /// The cheapest of all axes, the first of equals.
    Cut bestCut(const Range& range, const Bounds3& centres) const {
        std::array<Cut, 3> cuts;
        const auto tryOne = [&](int64_t axis) {
            if (centres.upper[int(axis)] > centres.lower[int(axis)])
                tryAxis(range, centres, static_cast<int>(axis), cuts[static_cast<size_t>(axis)]);
        };
        if (range.size() > kAlone) parallelFor(3, tryOne);
        else
            for (int axis = 0; axis < 3; ++axis) tryOne(axis);
        return *std::min_element(cuts.begin(), cuts.end(), [](const Cut& a, const Cut& b) { return a.cost < b.cost; });
    }

    static int binOf(float centre, const Bounds3& centres, int axis) {
        const float part = (centre - centres.lower[axis]) / (centres.upper[axis] - centres.lower[axis]);
        return std::clamp(static_cast<int>(part * kBins), 0, kBins - 1);
    }

    void tryAxis(const Range& range, const Bounds3& centres, int axis, Cut& best) const {
        std::array<LightBounds, kBins> bins;
        std::array<uint32_t, kBins> counts{};
        for (uint32_t i = range.begin; i < range.end; ++i) {
            const LightBounds& light = lights_[order_[i]];
            const auto bin = static_cast<size_t>(binOf(light.box.centre()[axis], centres, axis));
            bins[bin] = counts[bin]++ ? unite(bins[bin], light) : light;
        }
        // Right sides first, from the last bin on; then each cut with its left side.
        std::array<LightBounds, kBins> rights;
        LightBounds side;
        bool any = false;
        for (int b = kBins - 1; b > 0; --b) {
            const auto bin = static_cast<size_t>(b);
            if (counts[bin]) side = any ? unite(bins[bin], side) : bins[bin], any = true;
            rights[bin] = side;
        }
        uint32_t before = 0;
        any = false;
        for (int b = 1; b < kBins; ++b) {
            const auto bin = static_cast<size_t>(b - 1);
            if (counts[bin]) side = any ? unite(side, bins[bin]) : bins[bin], any = true;
            before += counts[bin];
            if (before == 0 || before == range.size()) continue;
            // Long boxes are better cut across their length (the paper's factor K_r).
            const Vec3 size = range.bounds.box.size();
            const float cost = (costOf(side) + costOf(rights[static_cast<size_t>(b)])) * maxComponent(size) /
                               std::max(size[axis], 1e-20f);
            if (cost < best.cost) best = {cost, axis, b, side, rights[static_cast<size_t>(b)]};
        }
    }

    std::span<const LightBounds> lights_;
    const std::stop_token stop_;
    std::vector<uint32_t> order_;
    NodePool nodes_;
};

uint64_t digestOf(std::span<const LightBounds> bounds) {
    uint64_t digest = bounds.size();
    const auto add = [&](float a, float b) {
        digest = mixBits(digest ^ ((uint64_t(std::bit_cast<uint32_t>(a)) << 32) | std::bit_cast<uint32_t>(b)));
    };
    for (const LightBounds& b : bounds) {
        add(b.box.lower.x, b.box.lower.y), add(b.box.lower.z, b.box.upper.x), add(b.box.upper.y, b.box.upper.z);
        add(b.axis.x, b.axis.y), add(b.axis.z, b.cosSpread), add(b.cosReach, b.intensity);
        add(b.bothSides ? 1.0f : 0.0f, 0);
    }
    return digest;
}

/// One whose place is not a number shines nowhere.
bool isSane(const LightBounds& b) {
    return isFinite(b.box.lower) && isFinite(b.box.upper) && isFinite(b.axis) && b.intensity > 0 &&
           std::isfinite(b.intensity);
}

}  // namespace

void LightTree::build(std::vector<LightBounds> bounds, const std::stop_token& stop) {
    kernels_ = &lightTreeKernels();
    const uint64_t digest = digestOf(bounds);
    if (digest == digest_ && ways_.size() == bounds.size()) return;
    digest_ = digest;
    nodes_.clear(), ways_.clear();
    if (bounds.empty()) return;
    for (LightBounds& light : bounds)
        if (!isSane(light)) light = LightBounds{{Vec3(0), Vec3(0)}, {0, 0, 1}, 1, 0, false, 0};
    Builder builder(bounds, stop);
    nodes_ = builder.takeNodes(builder.build(builder.whole()));
    rankLights(bounds, builder.takeOrder());
    findWays();
    findGroups();
    findFew();
}

void LightTree::rankLights(std::span<const LightBounds> lights, std::span<const uint32_t> order) {
    ways_.assign(lights.size(), {});
    ranks_.assign(lights.size() + 1, {});
    for (uint32_t rank = 0; rank < order.size(); ++rank) {
        ranks_[rank].light = order[rank];
        ranks_[rank + 1].before = ranks_[rank].before + double(lights[order[rank]].intensity);
        ways_[order[rank]].intensity = ranks_[rank + 1].before - ranks_[rank].before;
    }
}

void LightTree::findWays() {
    struct Way {
        uint64_t columns = 0;
        uint32_t length = 0;
    };
    std::vector<Way> waysTo(nodes_.size());
    // Children stand after their parents.
    for (uint32_t n = 0; n < nodes_.size(); ++n)
        for (uint32_t c = 0; c < kWidth; ++c) {
            const LightTreeNode& node = nodes_[n];
            Way way = waysTo[n];
            assert(way.length < LightTreeWay::kMost);
            way.columns |= uint64_t(c) << (LightTreeWay::kBits * way.length++);
            const uint32_t light = node.child[c] & ~LightTreeNode::kLight;
            if (light == node.child[c]) waysTo[node.child[c]] = way;
            else if (node.intensity[c] > 0)
                ways_[light].columns = way.columns | LightTreeWay::kEnd << (LightTreeWay::kBits * way.length);
        }
}

void LightTree::findGroups() {
    const auto count = static_cast<uint32_t>(ways_.size());
    std::vector<uint32_t> rankOf(count);
    for (uint32_t rank = 0; rank < count; ++rank) rankOf[ranks_[rank].light] = rank;
    groups_.assign(nodes_.size() * kWidth, {});
    // Children stand after their parents: backwards, every node knows its own range.
    std::vector<LightTreeGroup> ranges(nodes_.size(), {.begin = count});
    std::vector<bool> exact(nodes_.size(), true);  // every light below a node is told by the sums
    for (auto n = static_cast<uint32_t>(nodes_.size()); n-- > 0;)
        for (uint32_t c = 0; c < kWidth; ++c) {
            LightTreeNode& node = nodes_[n];
            const uint32_t child = node.child[c];
            LightTreeGroup group;
            if (child & LightTreeNode::kLight) {
                if (!(node.intensity[c] > 0)) continue;
                const uint32_t light = child & ~LightTreeNode::kLight;
                group.begin = rankOf[light], group.end = group.begin + 1;
                const double intensity = node.intensity[c];
                if (std::abs(ways_[light].intensity - intensity) > kMostRounding * intensity) exact[n] = false;
            } else {
                group = ranges[child];
                const bool alike = node.cosSpread[c] >= kGroupSpread && node.cosReach[c] <= 0;
                if (!exact[child]) exact[n] = false;
                else if (alike && group.end > group.begin && group.end - group.begin <= kMostInGroup)
                    node.far2[c] = kFarRadii * kFarRadii * node.radius[c] * node.radius[c];
            }
            group.before = ranks_[group.begin].before;
            group.intensity = ranks_[group.end].before - group.before;
            groups_[n * kWidth + c] = group;
            ranges[n].begin = std::min(ranges[n].begin, group.begin);
            ranges[n].end = std::max(ranges[n].end, group.end);
        }
}

void LightTree::findFew() {
    few_ = 0;
    for (int c = 0; c < kWidth; ++c) {
        if (!(nodes_[0].intensity[c] > 0)) continue;
        if (!(nodes_[0].child[c] & LightTreeNode::kLight) || c >= LightTreeView::kFew) {
            few_ = 0;
            return;
        }
        few_ = c + 1;
    }
}

size_t LightTree::byteCount() const {
    return nodes_.capacity() * sizeof(LightTreeNode) + groups_.capacity() * sizeof(LightTreeGroup) +
           ways_.capacity() * sizeof(LightTreeWay) + ranks_.capacity() * sizeof(LightTreeRank);
}

}  // namespace lumi
