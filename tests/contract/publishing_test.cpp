// A run that shows its live state while others listen: the threads of both, which the thread sanitizer watches.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <set>
#include <shaken/frame_t.hpp>
#include <thread>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "proto/bus.h"
#include "proto/channels.h"
#include "run/files/directory.h"
#include "run/loop/loop.h"

namespace shaken::run {
namespace {

TEST(Publishing, ARunIsSeenWhileItsThreadsStepAndEndsAsOneThatNobodySees) {
  scene::RunPlan plan;
  plan.system.rod.length = 2.5;
  plan.system.n_rods = 40;
  plan.system.box_side = 16;
  plan.system.dt = 2e-5;
  plan.measure_time = 1;
  plan.order = scene::MeasureOrder{0.002};
  plan.defects = scene::MeasureDefects{0.02};
  const ScratchFolder alone, watched;
  RunOptions options;
  options.directory = alone.path();
  plan.stream.reset();
  ASSERT_EQ(run(plan, options).state, RunState::kDone);

  const std::string url =
      "udpm://239.255.76.68:" + std::to_string(30000 + getpid() % 20000) + "?ttl=0&recv_buf_size=2097152";
  const auto bus = proto::Bus::open(url);
  ASSERT_TRUE(bus) << bus.error().message;
  std::set<std::int64_t> ticks;
  ASSERT_TRUE(
      (*bus)->subscribe<frame_t>(proto::kFrameChannel, [&](const frame_t& chunk) { ticks.insert(chunk.tick); }));
  std::atomic<bool> has_ended = false;
  std::jthread listener([&] {
    while (!has_ended || (*bus)->handle(0)) (*bus)->handle(20);
  });
  plan.stream = scene::Stream{.rate = 100};
  options.directory = watched.path();
  options.job_id = "watched";
  options.lcm_url = url;
  options.n_threads = 2;
  EXPECT_EQ(run(plan, options).state, RunState::kDone);
  has_ended = true;
  listener.join();
  ASSERT_GE(ticks.size(), 2U);
  EXPECT_LE(*ticks.rbegin(), 50000);

  const auto hash_in = [](const ScratchFolder& folder) {
    const auto text = read_file(RunDirectory{folder.path()}.summary());
    const std::string name = "\"state_hash\"";
    return text ? text->substr(text->find(name), 40) : "";
  };
  ASSERT_NE(hash_in(alone), "");
  EXPECT_EQ(hash_in(alone), hash_in(watched)) << "no result depends on live state";
}

}  // namespace
}  // namespace shaken::run
