#include <gtest/gtest.h>

#include <thread>

#include "base/messages.h"
#include "base/timer.h"

namespace lumi {
namespace {

TEST(Messages, RepeatedTextsAreCountedAndHeardOnce) {
    MessageLog log;
    int heard = 0;
    log.setListener([&](const Message& message) {
        ++heard;
        // The listener may use the log: it is called outside its lock.
        EXPECT_FALSE(log.messages().empty());
        EXPECT_EQ(message.repeats, 1);
    });
    log.warning("a");
    log.info("b");
    log.warning("a");
    log.error("a");
    EXPECT_EQ(heard, 3);
    ASSERT_EQ(log.messages().size(), 3u);
    EXPECT_EQ(log.messages()[1].repeats, 2);
    EXPECT_EQ(log.messages()[2].severity, Severity::Error);
    EXPECT_EQ(log.warnings(), std::vector<std::string>{"a"});
    log.clear();
    EXPECT_TRUE(log.messages().empty());
}

TEST(Messages, WhatIsReportedAgainIsTheLatest) {
    MessageLog log;
    log.warning("a");
    log.warning("b");
    const uint64_t before = log.serial();
    log.warning("a");
    EXPECT_GT(log.serial(), before);
    ASSERT_EQ(log.messages().size(), 2u);
    EXPECT_EQ(log.messages().back().text, "a");
    EXPECT_EQ(log.messages().back().serial, log.serial());
    EXPECT_EQ(log.warnings(), (std::vector<std::string>{"a", "b"})) << "as they came first, whoever repeats them";
    log.clear();
    EXPECT_GT(log.serial(), before + 1) << "a list that is empty is another one";
}

TEST(Messages, VeryManyTextsAreKept) {
    MessageLog log;
    for (int round = 0; round < 2; ++round)
        for (int i = 0; i < 100000; ++i) log.warning("of a file that is all wrong: " + std::to_string(i));
    EXPECT_EQ(log.warnings().size(), 100000u);
    EXPECT_EQ(log.messages().front().repeats, 2);
}

TEST(Messages, ManyThreadsMayReport) {
    MessageLog log;
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < 100; ++i) log.info("same");
        });
    for (std::thread& thread : threads) thread.join();
    ASSERT_EQ(log.messages().size(), 1u);
    EXPECT_EQ(log.messages()[0].repeats, 400);
}

TEST(Timer, StagesAddUpInTheirFirstOrder) {
    StageTimer timer;
    timer.add("trace", 2);
    timer.setPrefix("svgf.");
    { const auto scope = timer.measure("filter"); }
    timer.add("trace", 3);
    ASSERT_EQ(timer.stages().size(), 2u);
    EXPECT_EQ(timer.stages()[0], (std::pair<std::string, double>("trace", 5)));
    EXPECT_EQ(timer.stages()[1].first, "svgf.filter");
    EXPECT_GE(timer.stages()[1].second, 0);
    timer.clear();
    EXPECT_TRUE(timer.stages().empty());
}

}  // namespace
}  // namespace lumi
