#include "scene/length.h"

#include <algorithm>
#include <cmath>

namespace shaken::scene {

namespace {

constexpr double kGrowth = 1.25;  // from one end to the next

Tick ticks_of(const RunPlan& plan, double time) { return std::llround(time / plan.system.dt); }

}  // namespace

Tick total_ticks(const RunPlan& plan) { return ticks_of(plan, plan.total_time()); }

Tick most_ticks(const RunPlan& plan) { return ticks_of(plan, plan.longest_time()); }

Tick next_end(const RunPlan& plan, Tick from) {
  if (!plan.until) return std::max(total_ticks(plan), from);
  const Tick most = most_ticks(plan);
  double measured = plan.measure_time;
  for (;;) {
    const Tick end = ticks_of(plan, plan.steady.value_or(0.0) + measured);
    if (end >= most) return std::max(most, from);
    if (end >= from) return end;
    measured *= kGrowth;
  }
}

bool is_long_enough(const RunPlan& plan, Tick tick, const std::optional<KnownOrder>& order) {
  if (tick < total_ticks(plan)) return false;
  if (!plan.until || tick >= most_ticks(plan)) return true;
  return order && order->steady != false && order->sem <= plan.until->order_sem;
}

RunPlan as_long_as_both(RunPlan plan, const RunPlan& other) {
  plan.measure_time = std::max(plan.measure_time, other.measure_time);
  if (plan.until && other.until) {
    plan.until->order_sem = std::min(plan.until->order_sem, other.until->order_sem);
    plan.until->at_most = std::max(plan.until->at_most, other.until->at_most);
  } else if (other.until) {
    plan.until = other.until;
  }
  if (plan.until) plan.until->at_most = std::max(plan.until->at_most, plan.measure_time);
  return plan;
}

bool asks_for_more(const RunPlan& wanted, const RunPlan& present) {
  const RunPlan both = as_long_as_both(present, wanted);
  return both.measure_time != present.measure_time || both.until != present.until;
}

}  // namespace shaken::scene
