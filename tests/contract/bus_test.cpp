// SPDX-License-Identifier: MIT
// The bus on LCM's in-process provider, and what it says when LCM cannot start.
#include "proto/bus.h"

#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "tests/contract/samples.h"

namespace shaken::proto {
namespace {

std::unique_ptr<Bus> memory_bus() { return Bus::open("memq://").value(); }

void drain(Bus& bus) {
  while (bus.handle(20)) {
  }
}

TEST(Bus, CarriesEveryTypeOnItsChannel) {
  const auto bus = memory_bus();
  ASSERT_TRUE(bus);
  std::vector<std::int64_t> sequences;
  const auto note = [&](const auto& message) { sequences.push_back(message.sequence); };
  EXPECT_TRUE(bus->subscribe<status_t>(kStatusChannel, note));
  EXPECT_TRUE(bus->subscribe<job_t>(kJobChannel, note));
  EXPECT_TRUE(bus->subscribe<observables_t>(kObservablesChannel, note));
  EXPECT_TRUE(bus->subscribe<frame_static_t>(kFrameStaticChannel, note));
  EXPECT_TRUE(bus->subscribe<frame_t>(kFrameChannel, note));
  EXPECT_TRUE(bus->subscribe<defects_t>(kDefectsChannel, note));
  EXPECT_TRUE(bus->publish(kStatusChannel, samples::make<status_t>()));
  EXPECT_TRUE(bus->publish(kJobChannel, samples::make<job_t>()));
  EXPECT_TRUE(bus->publish(kObservablesChannel, samples::make<observables_t>()));
  EXPECT_TRUE(bus->publish(kFrameStaticChannel, samples::make<frame_static_t>()));
  EXPECT_TRUE(bus->publish(kFrameChannel, samples::make<frame_t>()));
  EXPECT_TRUE(bus->publish(kDefectsChannel, samples::make<defects_t>()));
  drain(*bus);
  EXPECT_EQ(sequences, (std::vector<std::int64_t>{41, 42, 43, 44, 45, 46}));
  EXPECT_EQ(bus->counters().published, 6);
  EXPECT_EQ(bus->counters().received, 6);
  EXPECT_EQ(bus->counters().refused, 0);
}

TEST(Bus, CountsAndRefusesAnotherType) {
  const auto bus = memory_bus();
  int n_frames = 0;
  bus->subscribe<frame_t>(kFrameChannel, [&](const frame_t&) { ++n_frames; });
  bus->publish(kFrameChannel, samples::make<status_t>());
  bus->publish(kFrameChannel, samples::make<frame_t>());
  drain(*bus);
  EXPECT_EQ(n_frames, 1);
  EXPECT_EQ(bus->counters().refused, 1);
}

TEST(Bus, HandlerExceptionsComeOutOfHandle) {
  const auto bus = memory_bus();
  bus->subscribe<status_t>(kStatusChannel, [](const status_t&) { throw std::runtime_error("handler gave up"); });
  bus->publish(kStatusChannel, samples::make<status_t>());
  bus->publish(kStatusChannel, samples::make<status_t>());
  EXPECT_THROW(bus->handle(1000), std::runtime_error);
  EXPECT_THROW(bus->handle(1000), std::runtime_error) << "and the bus goes on afterwards";
  EXPECT_FALSE(bus->handle(0));
}

TEST(Bus, WaitsNoLongerThanAsked) {
  const auto bus = memory_bus();
  bus->subscribe<status_t>(kStatusChannel, [](const status_t&) {});
  EXPECT_FALSE(bus->handle(0));
  EXPECT_FALSE(bus->handle(10));
}

TEST(Bus, ViewerQueueKeepsOne) {
  const auto bus = memory_bus();
  int n_seen = 0;
  bus->subscribe<status_t>(
      kStatusChannel, [&](const status_t&) { ++n_seen; }, 1);
  for (int i = 0; i < 5; ++i) bus->publish(kStatusChannel, samples::make<status_t>());
  drain(*bus);
  EXPECT_GE(n_seen, 1);
  EXPECT_LE(n_seen, 5);
}

TEST(Bus, PlainLcmReadsWhatItWritesToALog) {
  const auto file = std::filesystem::temp_directory_path() / ("shaken_bus_test_" + std::to_string(getpid()) + ".log");
  {
    const auto writer = Bus::open("file://" + file.string() + "?mode=w");
    ASSERT_TRUE(writer) << writer.error().message;
    EXPECT_TRUE(writer.value()->publish(kFrameChannel, samples::make<frame_t>()));
  }
  const auto reader = Bus::open("file://" + file.string() + "?speed=0");
  ASSERT_TRUE(reader) << reader.error().message;
  std::vector<frame_t> frames;
  reader.value()->subscribe<frame_t>(kFrameChannel, [&](const frame_t& frame) { frames.push_back(frame); });
  reader.value()->handle(2000);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(encode(frames[0]), encode(samples::make<frame_t>()));
  std::filesystem::remove(file);
}

TEST(Bus, SaysWhatIsWrongWithAnAddress) {
  const auto unknown = Bus::open("http://239.255.76.67:7667");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("udpm://"), std::string::npos) << unknown.error().message;
  const auto unicast = Bus::open("udpm://10.1.2.3:7667");
  ASSERT_FALSE(unicast);
  EXPECT_NE(unicast.error().message.find("not a multicast address"), std::string::npos) << unicast.error().message;
}

TEST(Bus, DefaultUrlComesFromTheEnvironmentFirst) {
  setenv("LCM_DEFAULT_URL", "memq://", 1);
  EXPECT_EQ(default_url(), "memq://");
  setenv("LCM_DEFAULT_URL", "", 1);
  EXPECT_EQ(default_url(), kDefaultUrl);
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(default_url(), kDefaultUrl);
}

TEST(Bus, LivesWithoutARelayOnTcpq) {
  // Port 1 of this machine: nobody listens there. LCM's own handleTimeout would abort the process here.
  const auto bus = Bus::open("tcpq://127.0.0.1:1");
  ASSERT_TRUE(bus) << bus.error().message;
  bus.value()->subscribe<status_t>(kStatusChannel, [](const status_t&) {});
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(bus.value()->handle(10));
  EXPECT_FALSE(bus.value()->publish(kStatusChannel, samples::make<status_t>()));
  EXPECT_EQ(bus.value()->counters().publish_failures, 1);
}

}  // namespace
}  // namespace shaken::proto
