// The bus on LCM's in-process provider, and what it says when LCM cannot start.
#include "proto/bus.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <thread>

#include "tests/contract/samples.h"
#include "tests/support/good.h"
#include "tests/support/lazy_server.h"

namespace shaken::proto {
namespace {

std::unique_ptr<Bus> memory_bus() { return Bus::open("memq://").value(); }

void drain(Bus& bus) {
  while (bus.handle(20)) {
  }
}

TEST(Bus, CarriesEveryTypeOnItsChannel) {
  const auto bus = test::good(memory_bus());
  std::vector<std::int64_t> sent, received;
  const auto send = [&]<class T>(const char* channel, const T& message) {
    EXPECT_TRUE(bus->subscribe<T>(channel, [&](const T& seen) { received.push_back(seen.sequence); }));
    EXPECT_TRUE(bus->publish(channel, message));
    sent.push_back(message.sequence);
  };
  send(kStatusChannel, samples::make<status_t>());
  send(kJobChannel, samples::make<job_t>());
  send(kObservablesChannel, samples::make<observables_t>());
  send(kFrameStaticChannel, samples::make<frame_static_t>());
  send(kFrameChannel, samples::make<frame_t>());
  send(kDefectsChannel, samples::make<defects_t>());
  send(kPostsChannel, samples::make<posts_t>());
  send(kSizesChannel, samples::make<sizes_t>());
  drain(*bus);
  EXPECT_EQ(received, sent);
  EXPECT_EQ(bus->counters().published, 8);
  EXPECT_EQ(bus->counters().received, 8);
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

TEST(Bus, ItsDescriptorTellsWhenSomethingWaits) {
  const auto bus = memory_bus();
  int n_jobs = 0;
  bus->subscribe<job_t>(kJobChannel, [&](const job_t&) { ++n_jobs; });
  const auto waits = [&] {
    pollfd readable{bus->descriptor(), POLLIN, 0};
    return poll(&readable, 1, 0) == 1;
  };
  EXPECT_GE(bus->descriptor(), 0);
  EXPECT_FALSE(waits());
  bus->publish(kJobChannel, samples::make<job_t>());
  EXPECT_TRUE(waits());
  EXPECT_TRUE(bus->handle(0));
  EXPECT_EQ(n_jobs, 1);
  EXPECT_FALSE(waits());
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
    const auto writer = test::good(Bus::open("file://" + file.string() + "?mode=w"));
    EXPECT_TRUE(writer.value()->publish(kFrameChannel, samples::make<frame_t>()));
  }
  const auto reader = test::good(Bus::open("file://" + file.string() + "?speed=0"));
  std::vector<frame_t> frames;
  reader.value()->subscribe<frame_t>(kFrameChannel, [&](const frame_t& frame) { frames.push_back(frame); });
  reader.value()->handle(2000);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(encode(frames[0]), encode(samples::make<frame_t>()));
  std::filesystem::remove(file);
}

TEST(Bus, SaysWhatIsWrongWithAnAddress) {
  EXPECT_THAT(test::refusal(Bus::open("http://239.255.76.67:7667")), testing::HasSubstr("udpm://"));
  EXPECT_THAT(test::refusal(Bus::open("udpm://10.1.2.3:7667")), testing::HasSubstr("not a multicast address"));
}

TEST(Bus, RefusesNamesThatTcpqWouldTakeForThisMachine) {
  EXPECT_THAT(test::refusal(Bus::open("tcpq://desk:7700")), testing::HasSubstr("four numbers"));
}

TEST(Bus, RawMessagesComeAsTheyAreSent) {
  const auto bus = memory_bus();
  std::vector<std::string> channels;
  std::vector<std::uint8_t> last;
  bus->subscribe_raw(
      "SHAKEN_.*",
      [&](std::string_view channel, std::span<const std::uint8_t> payload) {
        channels.emplace_back(channel);
        last.assign(payload.begin(), payload.end());
      },
      30);
  const std::vector<std::uint8_t> rubbish{1, 2, 3};
  bus->publish_bytes("OTHER", rubbish);
  bus->publish_bytes("SHAKEN_NEW", rubbish);
  drain(*bus);
  EXPECT_EQ(channels, std::vector<std::string>{"SHAKEN_NEW"});
  EXPECT_EQ(last, rubbish);
}

TEST(Bus, DefaultUrlComesFromTheEnvironmentFirst) {
  setenv("LCM_DEFAULT_URL", "memq://", 1);
  EXPECT_EQ(default_url(), "memq://");
  setenv("LCM_DEFAULT_URL", "", 1);
  EXPECT_EQ(default_url(), kDefaultUrl);
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(default_url(), kDefaultUrl);
}

/// A datagram of a message in two pieces, as LCM splits what is longer than one datagram.
std::string fragment(std::uint16_t number, std::uint32_t offset, const std::string& content) {
  std::string datagram = "LC03";
  for (const std::uint32_t word : {std::uint32_t{7}, std::uint32_t{100}, offset}) {
    const std::uint32_t ordered = htonl(word);
    datagram.append(reinterpret_cast<const char*>(&ordered), sizeof(ordered));
  }
  for (const std::uint16_t half : {number, std::uint16_t{2}}) {
    const std::uint16_t ordered = htons(half);
    datagram.append(reinterpret_cast<const char*>(&ordered), sizeof(ordered));
  }
  return datagram + content;
}

TEST(Bus, FragmentsDoNotReachLcm) {
  if (std::getenv("SHAKEN_OWN_NETWORK") == nullptr) GTEST_SKIP() << "needs a network of its own";
  const auto sender = Bus::open(kDefaultUrl), viewer = Bus::open(kDefaultUrl);
  ASSERT_TRUE(sender && viewer);
  int n_jobs = 0;
  viewer.value()->subscribe<job_t>(kJobChannel, [&](const job_t&) { ++n_jobs; });

  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(7667);
  inet_aton("239.255.76.67", &group.sin_addr);
  // The second piece lies almost 4 GB behind the first: LCM 1.3.1 writes there, and crashes.
  const std::string channel(kJobChannel);
  for (const std::string& piece :
       {fragment(0, 0, channel + std::string(1, '\0') + "x"), fragment(1, 0xfffffff0U, std::string(64, 'y'))}) {
    EXPECT_EQ(sendto(fd, piece.data(), piece.size(), 0, reinterpret_cast<const sockaddr*>(&group), sizeof(group)),
              static_cast<ssize_t>(piece.size()));
  }
  close(fd);
  EXPECT_TRUE(sender.value()->publish(kJobChannel, samples::make<job_t>()));
  EXPECT_TRUE(viewer.value()->handle(5000));
  EXPECT_EQ(n_jobs, 1);
}

TEST(Bus, LivesWithoutARelayOnTcpq) {
  // Port 1 of this machine: nobody listens there. LCM's own handleTimeout would abort the process here.
  const auto bus = test::good(Bus::open("tcpq://127.0.0.1:1"));
  bus.value()->subscribe<status_t>(kStatusChannel, [](const status_t&) {});
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(bus.value()->handle(10));
  EXPECT_FALSE(bus.value()->publish(kStatusChannel, samples::make<status_t>()));
  EXPECT_EQ(bus.value()->counters().publish_failures, 1);
}

// Nothing that is asked of a bus may take for ever: programs would not end on Ctrl-C, and the daemon not on SIGTERM.
TEST(Bus, LivesWithAServerThatSaysNothing) {
  const LazyServer server;
  const auto bus = test::good(Bus::open(server.url()));
  EXPECT_TRUE(bus.value()->subscribe<status_t>(kStatusChannel, [](const status_t&) {}));
  EXPECT_FALSE(bus.value()->handle(10));
  EXPECT_FALSE(bus.value()->publish(kStatusChannel, samples::make<status_t>()));
}

TEST(Bus, LeavesAServerThatTakesNothing) {
  LazyServer server;
  std::thread greeting([&] { server.greet(); });
  const auto bus = Bus::open(server.url());
  greeting.join();
  ASSERT_TRUE(bus) << bus.error().message;
  const std::vector<std::uint8_t> payload(100'000);
  int n_sent = 0;
  while (n_sent < 10'000 && bus.value()->publish_bytes("A", payload)) ++n_sent;
  EXPECT_GT(n_sent, 0);
  EXPECT_LT(n_sent, 10'000) << "a GB has gone somewhere";
}

TEST(Bus, LeavesAServerThatEndsInTheMiddleOfAMessage) {
  LazyServer server;
  std::thread greeting([&] {
    server.greet();
    server.say(std::string("\0\0\0\1\0\0", 6));
  });
  const auto bus = Bus::open(server.url());
  greeting.join();
  ASSERT_TRUE(bus) << bus.error().message;
  EXPECT_FALSE(bus.value()->handle(60'000));
}

}  // namespace
}  // namespace shaken::proto
