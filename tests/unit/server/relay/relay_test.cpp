// A relay on 127.0.0.1 with LCM's own clients, and with sockets that do what no client should.
#include "proto/relay/relay.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include <functional>

#include "proto/bus.h"
#include "tests/contract/samples.h"
#include "tests/support/good.h"

namespace shaken::relay {
namespace {

using namespace std::chrono_literals;
using proto::Bus;
using std::chrono::steady_clock;
using testing::StartsWith;

bool eventually(const std::function<bool()>& is_so) {
  const auto end = steady_clock::now() + 30s;
  while (!is_so()) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(2ms);
  }
  return true;
}

std::unique_ptr<Relay> relay(const Limits& limits = {}) {
  return Relay::start(parse_address("127.0.0.1:0").value(), nullptr, limits).value();
}

std::unique_ptr<Bus> lcm_client(const Relay& relay) { return Bus::open(relay.address().url()).value(); }

/// A connection that may send and leave unread what it likes.
class Raw {
 public:
  explicit Raw(const Relay& relay) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(relay.address().port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    constexpr int kSmall = 4096;
    setsockopt(socket_.value(), SOL_SOCKET, SO_RCVBUF, &kSmall, sizeof(kSmall));
    EXPECT_EQ(connect(socket_.value(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  }
  void send(std::string_view bytes) const {
    EXPECT_EQ(::send(socket_.value(), bytes.data(), bytes.size(), MSG_NOSIGNAL), std::ssize(bytes));
  }
  /// What comes until the relay closes; the first part if that does not happen.
  std::string received() const {
    std::string all;
    char piece[4096];
    pollfd readable{socket_.value(), POLLIN, 0};
    while (poll(&readable, 1, 30'000) > 0) {
      const ssize_t n = recv(socket_.value(), piece, sizeof(piece), 0);
      if (n <= 0) return all;
      all.append(piece, static_cast<std::size_t>(n));
    }
    return all + "(and it is still open)";
  }
  std::string received(std::size_t n_bytes) const {
    std::string all(n_bytes, '\0');
    return recv(socket_.value(), all.data(), n_bytes, MSG_WAITALL) == std::ssize(all) ? all : "";
  }

 private:
  Descriptor socket_;
};

TEST(Relay, HandsOnWhatOneClientSendsToThoseWhoSubscribed) {
  const auto middle = relay();
  const auto sender = lcm_client(*middle), jobs = lcm_client(*middle), frames = lcm_client(*middle);
  std::vector<std::int64_t> seen_jobs, seen_frames, own;
  jobs->subscribe<job_t>(proto::kJobChannel, [&](const job_t& message) { seen_jobs.push_back(message.sequence); });
  frames->subscribe<frame_t>(proto::kFrameChannel,
                             [&](const frame_t& message) { seen_frames.push_back(message.sequence); });
  sender->subscribe<job_t>("SHAKEN_J.*", [&](const job_t& message) { own.push_back(message.sequence); });
  // The relay has read the subscriptions once it has read a message that comes after them on each connection.
  for (const auto* client : {&jobs, &frames, &sender}) {
    EXPECT_TRUE((*client)->publish("SYNC", proto::samples::make<status_t>()));
  }
  ASSERT_TRUE(eventually([&] { return middle->counters().messages == 3; }));
  auto job = proto::samples::make<job_t>();
  for (job.sequence = 0; job.sequence < 3; ++job.sequence) EXPECT_TRUE(sender->publish(proto::kJobChannel, job));
  EXPECT_TRUE(sender->publish(proto::kFrameChannel, proto::samples::make<frame_t>()));
  EXPECT_TRUE(frames->handle(10'000));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(jobs->handle(10'000) && sender->handle(10'000));
  EXPECT_EQ(seen_jobs, (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(seen_frames.size(), 1U);
  EXPECT_EQ(own, seen_jobs) << "as multicast, which a sender hears too";
  EXPECT_FALSE(frames->handle(0));
  EXPECT_EQ(middle->counters().dropped, 0);
}

TEST(Relay, UnsubscribedIsSilent) {
  const auto middle = relay();
  const Raw client(*middle);
  client.send(client_greeting() + subscription(Kind::kSubscribe, "A") + subscription(Kind::kSubscribe, "B") +
              subscription(Kind::kUnsubscribe, "A") + publication("A", "1") + publication("B", "2"));
  EXPECT_EQ(client.received(8), server_greeting());
  const std::string expected = publication("B", "2");
  EXPECT_EQ(client.received(expected.size()), expected);
}

TEST(Relay, OneWhoNeverReadsLosesTheOldestAndNobodyElseLosesAnything) {
  const auto middle = relay();
  const Raw deaf(*middle);
  deaf.send(client_greeting() + subscription(Kind::kSubscribe, ".*") + publication("SYNC", ""));
  const auto good = lcm_client(*middle), sender = lcm_client(*middle);
  std::int64_t n_seen = 0, last = -1;
  good->subscribe<frame_t>(proto::kFrameChannel, [&](const frame_t& message) {
    EXPECT_EQ(message.sequence, last + 1);
    last = message.sequence;
    ++n_seen;
  });
  EXPECT_TRUE(good->publish("SYNC", proto::samples::make<status_t>()));
  ASSERT_TRUE(eventually([&] { return middle->counters().messages == 2; }));
  auto frame = proto::samples::make<frame_t>();
  frame.n_chunk_rods = 7000;
  for (auto* values : {&frame.x, &frame.y, &frame.heading, &frame.n_z}) values->assign(7000, 5);
  constexpr std::int64_t kFrames = 400;  // 22 MB: more than the system and the relay keep for one client
  for (frame.sequence = 0; frame.sequence < kFrames; ++frame.sequence) {
    ASSERT_TRUE(sender->publish(proto::kFrameChannel, frame));
    ASSERT_TRUE(good->handle(20'000));
  }
  EXPECT_EQ(n_seen, kFrames);
  EXPECT_GT(middle->counters().dropped, 100);
  EXPECT_EQ(middle->counters().clients, 3) << "it may go on when it has the time";
}

TEST(Relay, AVolleyOfSmallMessagesReachesOneWhoReads) {
  const auto middle = relay();
  const Raw client(*middle);
  client.send(client_greeting() + subscription(Kind::kSubscribe, "A"));
  EXPECT_EQ(client.received(8), server_greeting());
  std::string volley, expected;
  for (int i = 0; i < 3000; ++i) volley += publication("A", std::to_string(i));
  std::thread reader([&] { expected = client.received(volley.size()); });
  const Raw sender(*middle);
  sender.send(client_greeting() + volley);
  reader.join();
  EXPECT_EQ(expected, volley);
  EXPECT_EQ(middle->counters().dropped, 0);
}

TEST(Relay, RubbishIsSentAwayAndTheOthersStay) {
  const auto middle = relay();
  const Raw good(*middle);
  good.send(client_greeting() + subscription(Kind::kSubscribe, "A"));
  EXPECT_EQ(good.received(8), server_greeting());
  std::string too_many = client_greeting();
  for (int i = 0; i < 33; ++i) too_many += subscription(Kind::kSubscribe, "A");
  const std::string greeting = client_greeting();
  const std::vector<std::string> rubbish{"GET / HTTP/1.1\r\n\r\n",
                                         greeting + std::string(100, '\xff'),
                                         greeting + subscription(Kind::kSubscribe, "("),
                                         greeting + subscription(Kind::kSubscribe, std::string(300, 'a')),
                                         greeting + publication(std::string(64, 'a'), ""),
                                         greeting + publication("A", std::string((1 << 20) + 1, 'x')).substr(0, 100),
                                         too_many};
  std::int64_t n = 0;
  for (const std::string& bytes : rubbish) {
    const Raw client(*middle);
    client.send(bytes);
    const std::string answer = client.received();
    EXPECT_TRUE(answer.empty() || answer == server_greeting()) << answer;
    EXPECT_TRUE(eventually([&] { return middle->counters().sent_away == n + 1; })) << bytes.substr(0, 30);
    ++n;
  }
  const Raw sender(*middle);
  sender.send(greeting + publication("A", "still there"));
  const std::string expected = publication("A", "still there");
  EXPECT_EQ(good.received(expected.size()), expected);
}

TEST(Relay, MoreThanItTakesAreClosedAtOnceAndThereIsRoomAgainWhenOneGoes) {
  Limits limits;
  limits.clients = 3;
  const auto middle = relay(limits);
  std::vector<std::unique_ptr<Raw>> clients;
  for (int i = 0; i < 3; ++i) {
    clients.push_back(std::make_unique<Raw>(*middle));
    clients.back()->send(client_greeting());
    EXPECT_EQ(clients.back()->received(8), server_greeting());
  }
  EXPECT_EQ(Raw(*middle).received(), "") << "closed without a word";
  const auto bus = lcm_client(*middle);  // LCM's client is not left waiting either
  EXPECT_EQ(bus->descriptor(), -1);
  clients.pop_back();
  ASSERT_TRUE(eventually([&] { return middle->counters().clients == 2; }));
  EXPECT_GE(lcm_client(*middle)->descriptor(), 0);
}

TEST(Relay, TimeRunsOutForOneWhoSaysNothing) {
  Limits limits;
  limits.greeting = 0s;
  const auto middle = relay(limits);
  EXPECT_EQ(Raw(*middle).received(), "");
  EXPECT_TRUE(eventually([&] { return middle->counters().sent_away == 1; }));
}

TEST(Relay, TimeRunsOutForHalfAMessage) {
  Limits limits;
  limits.message = 0s;
  const auto middle = relay(limits);
  const Raw half(*middle);
  half.send(client_greeting() + publication("A", "x").substr(0, 9));
  EXPECT_EQ(half.received(), server_greeting());
  EXPECT_TRUE(eventually([&] { return middle->counters().sent_away == 1; }));
}

TEST(Relay, TimeRunsOutForOneWhoTakesNothing) {
  Limits limits;
  limits.standstill = 0s;
  const auto middle = relay(limits);
  const Raw deaf(*middle), sender(*middle);
  deaf.send(client_greeting() + subscription(Kind::kSubscribe, "A") + publication("SYNC", ""));
  sender.send(client_greeting());
  ASSERT_TRUE(eventually([&] { return middle->counters().messages == 1; }));
  const std::string much = publication("A", std::string(1 << 20, 'x'));
  for (int i = 0; i < 8; ++i) sender.send(much);
  EXPECT_TRUE(eventually([&] { return middle->counters().sent_away == 1; }));
}

TEST(Relay, EndsWhileClientsAreConnectedAndItsPortIsFreeAgain) {
  auto middle = relay();
  const Address address = middle->address();
  const auto bus = lcm_client(*middle);
  bus->subscribe<job_t>(proto::kJobChannel, [](const job_t&) {});
  EXPECT_THAT(test::refusal(Relay::start(address, nullptr)), StartsWith("the relay cannot listen at 127.0.0.1:"));
  middle.reset();
  const auto again = test::good(Relay::start(address, nullptr));
  EXPECT_TRUE(eventually([&] {
    bus->handle(10);
    return (*again)->counters().clients == 1;
  })) << "and a client comes back by itself";
}

TEST(Relay, TheBridgedBusIsHandedOnAndGetsNothingBack) {
  if (std::getenv("SHAKEN_OWN_NETWORK") == nullptr) GTEST_SKIP() << "needs a network of its own";
  const auto middle = Relay::start(parse_address("127.0.0.1:0").value(), Bus::open(proto::kDefaultUrl).value()).value();
  const auto outside = Bus::open(proto::kDefaultUrl).value();
  int n_outside = 0;
  outside->subscribe<job_t>(proto::kJobChannel, [&](const job_t&) { ++n_outside; });
  const auto client = lcm_client(*middle);
  int n_inside = 0;
  client->subscribe<job_t>(proto::kJobChannel, [&](const job_t&) { ++n_inside; });
  client->subscribe<status_t>("SYNC", [&](const status_t&) {});
  EXPECT_TRUE(client->publish("SYNC", proto::samples::make<status_t>()));
  EXPECT_TRUE(client->handle(10'000));
  EXPECT_TRUE(outside->publish(proto::kJobChannel, proto::samples::make<job_t>()));
  EXPECT_TRUE(client->handle(10'000));
  EXPECT_TRUE(outside->handle(10'000));
  EXPECT_TRUE(client->publish(proto::kJobChannel, proto::samples::make<job_t>()));
  EXPECT_TRUE(client->handle(10'000));
  EXPECT_FALSE(outside->handle(100));
  EXPECT_EQ(n_inside, 2);
  EXPECT_EQ(n_outside, 1);
}

}  // namespace
}  // namespace shaken::relay
