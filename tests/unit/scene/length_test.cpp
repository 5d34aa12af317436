// SPDX-License-Identifier: MIT
#include "scene/length.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "scene/canonical.h"
#include "tests/unit/scene/support.h"

namespace shaken::scene {
namespace {

RunPlan random_length() {
  RunPlan plan;
  plan.measure_time = *rc::gen::inRange(1, 5);
  if (*rc::gen::arbitrary<bool>()) plan.until = Until{0.001 * *rc::gen::inRange(1, 4), 1.0 * *rc::gen::inRange(5, 9)};
  return plan;
}

TEST(Length, OfTwoScenesIsTheLongerOfEach) {
  EXPECT_TRUE(rc::check("as_long_as_both is a least upper bound", [] {
    const RunPlan a = random_length(), b = random_length(), c = random_length();
    const RunPlan both = as_long_as_both(a, b);
    RC_ASSERT(both == as_long_as_both(b, a));
    RC_ASSERT(as_long_as_both(both, c) == as_long_as_both(a, as_long_as_both(b, c)));
    RC_ASSERT(!asks_for_more(a, both) && !asks_for_more(b, both));
    RC_ASSERT(as_long_as_both(a, a) == a && !asks_for_more(a, a));
    if (!asks_for_more(a, b)) RC_ASSERT(both == b);
    RC_ASSERT(both.longest_time() == std::max(a.longest_time(), b.longest_time()));
  }));
}

TEST(Length, MustMakeSense) {
  const auto problems = [](const char* text) {
    const Loaded<RunPlan> plan = load_scene(text, "f");
    return plan ? std::string() : to_string(plan.error());
  };
  EXPECT_EQ(problems(R"({"until": {}})"), "");
  EXPECT_NE(problems(R"({"until": {}, "measure": {"order": null}})").find("measure.order"), std::string::npos);
  EXPECT_NE(problems(R"({"until": {"at_most": 5}, "time": {"measure": 6}})").find("shorter than time.measure 6 s"),
            std::string::npos);
}

}  // namespace
}  // namespace shaken::scene
