// Tests trees over triangles, and the steps that make them.
#include "scene/device/trees/bvh.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <numeric>
#include <random>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "scene/device/run_both.h"
#include "scene/device/trees/collapse.h"
#include "scene/device/trees/parallel_partition.h"
#include "scene/device/trees/reinsertion.h"

namespace limpid::scene {
namespace {

constexpr unsigned seed = 2026;

/// Long thin triangles in all directions among small ones, flat ones, and some without an area.
std::vector<Corners> mixedTriangles(size_t count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-1.0f, 1.0f);
    const auto point = [&](float size) { return size * vec3(place(random), place(random), place(random)); };
    std::vector<Corners> triangles;
    for (size_t i = 0; i < count; ++i) {
        const vec3 at = point(10.0f);
        Corners corners{at, at + point(0.1f), at + point(0.1f)};
        if (i % 8 == 0) corners[1] = at + point(8.0f);
        if (i % 16 == 1) corners[1].y = corners[2].y = at.y;
        if (i % 64 == 2) corners[2] = corners[1];
        triangles.push_back(corners);
    }
    return triangles;
}

std::vector<Aabb> boxesOf(const std::vector<Corners>& triangles) {
    std::vector<Aabb> boxes;
    for (const Corners& corners : triangles) boxes.push_back(boxOf(corners));
    return boxes;
}

bool contains(const Aabb& box, const vec3& point) {
    return glm::all(glm::lessThanEqual(box.lower, point)) && glm::all(glm::lessThanEqual(point, box.upper));
}

/// Whether a leaf with this triangle can be reached through boxes that contain the point.
bool reaches(const Bvh& bvh, uint32_t ref, const vec3& point, uint32_t triangle) {
    if (BvhRef::isLeaf(ref)) {
        const auto first = bvh.order.begin() + BvhRef::first(ref);
        return std::find(first, first + BvhRef::count(ref), triangle) != first + BvhRef::count(ref);
    }
    const BvhNode& node = bvh.nodes[ref];
    for (uint32_t child = 0; child < 4; ++child) {
        if (node.hasChild(child) && contains(node.childBounds(child), point) &&
            reaches(bvh, node.children[child], point, triangle))
            return true;
    }
    return false;
}

/// The areas of all boxes of nodes, and of leaves times their triangles: what rays cost.
double costOf(const Bvh& bvh) {
    double cost = bvh.bounds.halfArea();
    for (const BvhNode& node : bvh.nodes) {
        for (uint32_t child = 0; child < 4; ++child) {
            if (!node.hasChild(child)) continue;
            const uint32_t ref = node.children[child];
            const double area = node.childBounds(child).halfArea();
            cost += BvhRef::isLeaf(ref) ? area * BvhRef::count(ref) : area;
        }
    }
    return cost / bvh.bounds.halfArea();
}

TEST(TriangleBvh, EveryPointOfATriangleLiesInALeafOfIt) {
    const std::vector<Corners> triangles = mixedTriangles(4000);
    const Bvh bvh = buildTriangleBvh(triangles, std::vector<bool>(triangles.size(), true));
    EXPECT_GT(bvh.order.size(), triangles.size()) << "nothing was split";
    std::mt19937 random(seed + 1);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        const auto& [a, b, c] = triangles[i];
        for (int sample = 0; sample < 64; ++sample) {
            // Exact corners and edges, too.
            const double u = sample < 2 ? sample : share(random),
                         v = sample % 4 == 0 ? 0.0 : (1.0 - u) * share(random);
            const vec3 point(glm::dvec3(a) + u * (glm::dvec3(b) - glm::dvec3(a)) +
                             v * (glm::dvec3(c) - glm::dvec3(a)));
            // Rays find a point within rounding, and their boxes are that much larger.
            if (!contains(boxOf(triangles[i]), point)) continue;
            ASSERT_TRUE(reaches(bvh, 0, point, i)) << "triangle " << i << ", u " << u << ", v " << v;
        }
    }
}

TEST(TriangleBvh, KeepsWholeWhatMayNotBeSplit) {
    const std::vector<Corners> triangles = mixedTriangles(2000);
    std::vector<bool> divisible(triangles.size(), true);
    for (size_t i = 0; i < divisible.size(); i += 16) divisible[i] = false;
    const Bvh bvh = buildTriangleBvh(triangles, divisible);
    std::vector<int> times(triangles.size(), 0);
    for (const uint32_t triangle : bvh.order) ++times[triangle];
    for (size_t i = 0; i < times.size(); ++i) {
        EXPECT_GE(times[i], 1) << i;
        if (!divisible[i]) {
            EXPECT_EQ(times[i], 1) << i;
        }
    }
    EXPECT_GT(*std::max_element(times.begin(), times.end()), 2);
}

TEST(TriangleBvh, ALeafHasATriangleOnce) {
    const std::vector<Corners> triangles = mixedTriangles(2000);
    const Bvh bvh = buildTriangleBvh(triangles, std::vector<bool>(triangles.size(), true));
    for (const BvhNode& node : bvh.nodes) {
        for (uint32_t child = 0; child < 4; ++child) {
            if (!node.hasChild(child) || !BvhRef::isLeaf(node.children[child])) continue;
            const auto first = bvh.order.begin() + BvhRef::first(node.children[child]);
            std::vector<uint32_t> leaf(first, first + BvhRef::count(node.children[child]));
            std::sort(leaf.begin(), leaf.end());
            EXPECT_EQ(std::adjacent_find(leaf.begin(), leaf.end()), leaf.end());
        }
    }
}

TEST(TriangleBvh, CostsRaysLess) {
    const std::vector<Corners> triangles = mixedTriangles(20000);
    const std::vector<bool> all(triangles.size(), true), none(triangles.size(), false);
    const double plain = costOf(buildBvh(boxesOf(triangles), 4));
    const double moved = costOf(buildTriangleBvh(triangles, none));
    const double split = costOf(buildTriangleBvh(triangles, all));
    EXPECT_LT(moved, 0.95 * plain);
    EXPECT_LT(split, 0.7 * moved);
}

TEST(TriangleBvh, IsTheSameEachTime) {
    // Many pairs of triangles with equal boxes.
    std::vector<Corners> triangles;
    for (int i = 0; i < 12000; ++i) {
        const vec3 at(i % 100, i / 100, (i * i) % 7);
        triangles.push_back({at, at + vec3(1, 0, 0), at + vec3(1, 1, 0)});
        triangles.push_back({at, at + vec3(1, 1, 0), at + vec3(0, 1, 0)});
    }
    const std::vector<bool> divisible(triangles.size(), true);
    const Bvh first = buildTriangleBvh(triangles, divisible);
    for (int time = 0; time < 3; ++time) {
        const Bvh again = buildTriangleBvh(triangles, divisible);
        EXPECT_EQ(first.order, again.order);
        ASSERT_EQ(first.nodes.size(), again.nodes.size());
        EXPECT_EQ(std::memcmp(first.nodes.data(), again.nodes.data(), first.nodes.size() * sizeof(BvhNode)),
                  0);
    }
}

/// What a traversal meets.
struct Met {
    std::vector<int> nodes, entries;  ///< how often
    uint32_t outside = 0;             ///< triangles that leave the box of their leaf
};

void traverse(const Bvh& bvh, const std::vector<Corners>& triangles, uint32_t index, Met& met) {
    ++met.nodes[index];
    const BvhNode& node = bvh.nodes[index];
    for (uint32_t child = 0; child < 4; ++child) {
        if (!node.hasChild(child)) continue;
        const uint32_t ref = node.children[child];
        if (!BvhRef::isLeaf(ref)) {
            traverse(bvh, triangles, ref, met);
            continue;
        }
        for (uint32_t i = BvhRef::first(ref); i < BvhRef::first(ref) + BvhRef::count(ref); ++i) {
            ++met.entries[i];
            const Aabb box = boxOf(triangles[bvh.order[i]]), leaf = node.childBounds(child);
            met.outside += !contains(leaf, box.lower) || !contains(leaf, box.upper);
        }
    }
}

/// Several threads write the nodes of one tree.
TEST(TriangleBvh, OfManyTrianglesIsWhole) {
    const std::vector<Corners> triangles = mixedTriangles(40000);
    for (const bool divisible : {false, true}) {
        const Bvh bvh = buildTriangleBvh(triangles, std::vector<bool>(triangles.size(), divisible));
        Met met{std::vector<int>(bvh.nodes.size()), std::vector<int>(bvh.order.size())};
        traverse(bvh, triangles, 0, met);
        EXPECT_EQ(std::count(met.nodes.begin(), met.nodes.end(), 1), bvh.nodes.size());
        EXPECT_EQ(std::count(met.entries.begin(), met.entries.end(), 1), bvh.order.size());
        std::vector<int> times(triangles.size());
        for (const uint32_t triangle : bvh.order) ++times[triangle];
        EXPECT_EQ(std::count(times.begin(), times.end(), 0), 0);
        if (!divisible) {
            EXPECT_EQ(bvh.order.size(), triangles.size());
            EXPECT_EQ(met.outside, 0u);
        }
        const Bvh again = buildTriangleBvh(triangles, std::vector<bool>(triangles.size(), divisible));
        EXPECT_EQ(bvh.order, again.order);
        ASSERT_EQ(bvh.nodes.size(), again.nodes.size());
        EXPECT_EQ(std::memcmp(bvh.nodes.data(), again.nodes.data(), bvh.nodes.size() * sizeof(BvhNode)), 0);
    }
}

References referencesOf(const std::vector<Corners>& triangles) {
    References references;
    for (uint32_t i = 0; i < triangles.size(); ++i) references.push_back({boxOf(triangles[i]), i});
    return references;
}

TEST(TriangleBvh, BuiltInPartsIsWholeAndCostsLittleMore) {
    const std::vector<Corners> triangles = mixedTriangles(20000);
    const double whole = costOf(buildBvh(boxesOf(triangles), 4));
    // The root of a part is a node of its own, or a leaf.
    const std::vector<std::pair<uint32_t, double>> most{{2, 1.4}, {100, 1.03}, {3000, 1.004}, {20000, 1.0}};
    for (const auto& [partSize, share] : most) {
        const Bvh bvh = buildBvhInParts(referencesOf(triangles), 4, partSize);
        Met met{std::vector<int>(bvh.nodes.size()), std::vector<int>(bvh.order.size())};
        traverse(bvh, triangles, 0, met);
        EXPECT_EQ(std::count(met.nodes.begin(), met.nodes.end(), 1), bvh.nodes.size());
        EXPECT_EQ(std::count(met.entries.begin(), met.entries.end(), 1), triangles.size());
        EXPECT_EQ(met.outside, 0u);
        std::vector<uint32_t> order(bvh.order.begin(), bvh.order.end());
        std::sort(order.begin(), order.end());
        for (uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
        EXPECT_LE(costOf(bvh), share * whole) << partSize;
        const Bvh again = buildBvhInParts(referencesOf(triangles), 4, partSize);
        EXPECT_EQ(bvh.order, again.order);
        ASSERT_EQ(bvh.nodes.size(), again.nodes.size());
        EXPECT_EQ(std::memcmp(bvh.nodes.data(), again.nodes.data(), bvh.nodes.size() * sizeof(BvhNode)), 0);
    }
    EXPECT_EQ(buildBvhInParts({}, 4, 100).order.size(), 0u);
    EXPECT_EQ(buildBvhInParts(referencesOf({triangles[0]}), 4, 100).order.size(), 1u);
}

/// Several threads make the tree, which one triangle spans.
TEST(TriangleBvh, ALargeTriangleBesideManySmallOnesIsALeafAtTheTop) {
    std::vector<Corners> triangles = mixedTriangles(80000);
    for (Corners& triangle : triangles) {
        for (vec3& corner : triangle) corner = 0.001f * corner;
    }
    triangles.push_back({vec3(-1000, 0, 0), vec3(1000, 0, 0), vec3(0, 1000, 0)});
    const auto large = static_cast<uint32_t>(triangles.size() - 1);
    for (const bool inParts : {false, true}) {
        const Bvh bvh = inParts ? buildBvhInParts(referencesOf(triangles), 4, 1u << 15)
                                : buildTriangleBvh(referencesOf(triangles));
        Met met{std::vector<int>(bvh.nodes.size()), std::vector<int>(bvh.order.size())};
        traverse(bvh, triangles, 0, met);
        EXPECT_EQ(std::count(met.nodes.begin(), met.nodes.end(), 1), bvh.nodes.size());
        EXPECT_EQ(std::count(met.entries.begin(), met.entries.end(), 1), triangles.size());
        EXPECT_EQ(met.outside, 0u);
        bool found = false;
        for (uint32_t child = 0; child < 4; ++child) {
            const uint32_t ref = bvh.nodes[0].children[child];
            if (!bvh.nodes[0].hasChild(child) || !BvhRef::isLeaf(ref)) continue;
            found |= bvh.order[BvhRef::first(ref)] == large;
        }
        EXPECT_TRUE(found) << inParts;
    }
}

/// Gives build(progress) up before it begins, and whenever `step` percent more are done.
template <typename Build>
void expectCanBeGivenUp(int step, const Build& build) {
    const Progress givenUp = Progress::watched();
    givenUp.cancel();
    EXPECT_THROW(build(givenUp), Cancelled);
    for (int percent = 0; percent < 100; percent += step) {
        const Progress progress = Progress::watched();
        std::jthread canceller([&](const std::stop_token& isBuilt) {
            while (100.0 * progress.done() < percent && !isBuilt.stop_requested()) std::this_thread::yield();
            progress.cancel();
        });
        try {
            build(progress);
        } catch (const Cancelled&) {
        }
        canceller.request_stop();
    }
}

TEST(TriangleBvh, BuiltInPartsCanBeGivenUp) {
    const std::vector<Corners> triangles = mixedTriangles(10000);
    expectCanBeGivenUp(20, [&](const Progress& progress) {
        EXPECT_EQ(buildBvhInParts(referencesOf(triangles), 4, 64, progress).order.size(), 10000u);
    });
}

TEST(RunAll, CallsAllAndThrowsTheFirstFault) {
    for (const size_t count : {0, 1, 2, 7, 100}) {
        std::vector<std::atomic<int>> calls(count);
        runAll(count, [&](size_t i) { ++calls[i]; });
        for (const std::atomic<int>& times : calls) EXPECT_EQ(times, 1);
    }
    std::atomic<int> called = 0;
    const auto throwing = [&](size_t i) {
        ++called;
        if (i % 5 == 3) throw std::runtime_error(std::to_string(i));
    };
    try {
        runAll(20, throwing);
        ADD_FAILURE();
    } catch (const std::runtime_error& fault) {
        EXPECT_STREQ(fault.what(), "3");
    }
    EXPECT_EQ(called, 20);
}

TEST(RunBoth, FinishesOneWhenTheOtherThrows) {
    std::atomic<bool> begun = false;
    std::atomic<int> count = 0;
    const auto throws = [&] {
        while (!begun) std::this_thread::yield();
        throw Cancelled();
    };
    const auto counts = [&] {
        begun = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        tbb::parallel_for(0, 1000, [&](int) { ++count; });
    };
    EXPECT_THROW(runBoth(counts, throws), Cancelled);
    EXPECT_EQ(count, 1000);
}

/// At any time, with a tree or without one.
TEST(TriangleBvh, CanBeGivenUp) {
    const std::vector<Corners> triangles = mixedTriangles(10000);
    const std::vector<bool> divisible(triangles.size(), true);
    expectCanBeGivenUp(7, [&](const Progress& progress) {
        EXPECT_GE(buildTriangleBvh(triangles, divisible, progress).order.size(), triangles.size());
    });
}

TEST(PartitionInParallel, IsAPartition) {
    std::mt19937 random(seed);
    std::vector<uint32_t> numbers(777777);
    for (const uint32_t below : {0u, 1u, 70000u, 388888u, 777776u, 777777u}) {
        std::iota(numbers.begin(), numbers.end(), 0u);
        std::shuffle(numbers.begin(), numbers.end(), random);
        std::vector<uint32_t> again = numbers;
        const auto isLeft = [&](uint32_t number) { return number < below; };
        ASSERT_EQ(partitionInParallel(std::span(numbers), isLeft), below);
        EXPECT_TRUE(std::all_of(numbers.begin(), numbers.begin() + below, isLeft));
        partitionInParallel(std::span(again), isLeft);
        EXPECT_EQ(numbers, again);
        std::sort(numbers.begin(), numbers.end());
        for (uint32_t i = 0; i < numbers.size(); ++i) ASSERT_EQ(numbers[i], i);
    }
}

TEST(TriangleBvh, TakesOneTriangleAndManyAtOnePlace) {
    for (const size_t count : {1, 2, 3, 5, 100}) {
        const std::vector<Corners> triangles(count, Corners{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)});
        const Bvh bvh = buildTriangleBvh(triangles, std::vector<bool>(count, true));
        for (uint32_t i = 0; i < count; ++i) EXPECT_TRUE(reaches(bvh, 0, vec3(0.25f, 0.25f, 0.0f), i));
    }
    EXPECT_EQ(buildTriangleBvh(std::vector<Corners>{}, {}).order.size(), 0u);
}

TEST(Clip, APartIsTheTriangleWithinTheBox) {
    const Corners triangle{vec3(0, 0, 0), vec3(4, 0, 0), vec3(0, 4, 2)};
    const Aabb part = clipped(triangle, {vec3(1, 0, 0), vec3(4, 4, 2)});
    EXPECT_NEAR(part.lower.x, 1.0f, 1e-5f);
    EXPECT_NEAR(part.upper.x, 4.0f, 1e-5f);
    EXPECT_NEAR(part.upper.y, 3.0f, 1e-5f);  // at x = 1
    EXPECT_NEAR(part.upper.z, 1.5f, 1e-5f);
    EXPECT_GE(part.upper.y, 3.0f);
}

BinaryTree treeOver(const std::vector<Corners>& triangles) {
    return buildBinaryTree(referencesOf(triangles), maxSahDepth);
}

double areaOf(const BinaryTree& tree) {
    double sum = 0.0;
    for (const BinaryNode& node : tree) sum += node.bounds.halfArea();
    return sum;
}

/// Adds the primitives below a node, and checks that its box is that of its children.
void collectLeaves(const BinaryTree& tree, uint32_t index, std::vector<uint32_t>& leaves) {
    const BinaryNode& node = tree[index];
    if (node.isLeaf()) {
        leaves.push_back(node.primitive);
        return;
    }
    Aabb both = tree[node.child].bounds;
    both.grow(tree[node.child + 1].bounds);
    EXPECT_EQ(both.lower, node.bounds.lower);
    EXPECT_EQ(both.upper, node.bounds.upper);
    collectLeaves(tree, node.child, leaves);
    collectLeaves(tree, node.child + 1, leaves);
}

TEST(Reinsertion, KeepsAllLeavesAndLowersTheArea) {
    BinaryTree tree = treeOver(mixedTriangles(3000));
    double area = areaOf(tree);
    for (int round = 0; round < 8; ++round) {
        reinsert(tree, 1, {});
        EXPECT_LE(areaOf(tree), area * 1.000001);
        area = areaOf(tree);
        std::vector<uint32_t> leaves;
        collectLeaves(tree, 0, leaves);
        std::sort(leaves.begin(), leaves.end());
        ASSERT_EQ(leaves.size(), 3000u);
        for (uint32_t i = 0; i < leaves.size(); ++i) ASSERT_EQ(leaves[i], i);
    }
    EXPECT_LT(area, 0.95 * areaOf(treeOver(mixedTriangles(3000))));
}

/// The least cost of a subtree as at most `slots` children, by trying everything. `nodeCost` as in
/// collapse.cpp.
double leastCost(const BinaryTree& tree, uint32_t index, uint32_t slots) {
    constexpr double nodeCost = 1.7;
    const BinaryNode& node = tree[index];
    const double area = node.bounds.halfArea();
    if (node.isLeaf()) return area;
    std::vector<uint32_t> leaves;
    collectLeaves(tree, index, leaves);
    double best = leaves.size() <= 4 ? area * static_cast<double>(leaves.size()) : 1e300;
    const auto divided = [&](uint32_t all) {
        double least = 1e300;
        for (uint32_t left = 1; left < all; ++left) {
            least = std::min(least,
                             leastCost(tree, node.child, left) + leastCost(tree, node.child + 1, all - left));
        }
        return least;
    };
    best = std::min(best, nodeCost * area + divided(4));
    for (uint32_t all = 2; all <= slots; ++all) best = std::min(best, divided(all));
    return best;
}

/// What the collapsed tree costs.
double costOf(const Collapse& collapse, uint32_t index) {
    const BinaryTree& tree = collapse.tree();
    double cost = 1.7 * tree[index].bounds.halfArea();
    for (const uint32_t child : collapse.childrenOf(index)) {
        if (!collapse.becomesLeaf(child)) {
            cost += costOf(collapse, child);
            continue;
        }
        std::vector<uint32_t> leaves;
        collectLeaves(tree, child, leaves);
        cost += static_cast<double>(leaves.size()) * tree[child].bounds.halfArea();
    }
    return cost;
}

TEST(Collapse, IsAsGoodAsTryingEverything) {
    for (size_t count = 5; count <= 12; ++count) {
        const BinaryTree tree = treeOver(mixedTriangles(count));
        const Collapse collapse(tree, 4);
        EXPECT_NEAR(costOf(collapse, 0), leastCost(tree, 0, 1), 1e-5 * leastCost(tree, 0, 1)) << count;
    }
}

}  // namespace
}  // namespace limpid::scene
