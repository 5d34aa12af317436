#include "run/recorded/measure_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "run/measure/measurements.h"
#include "scene/canonical.h"
#include "scene/load.h"

namespace shaken::run {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// What a scene says that a measurement of its frames has no part in.
constexpr std::string_view kFree[] = {"measure", "trajectory", "stream", "movie", "until"};
constexpr std::string_view kFreeOfTime[] = {"steady", "measure"};

OrderedJson without(OrderedJson json, std::span<const std::string_view> names) {
  for (const std::string_view name : names) json.erase(std::string(name));
  return json;
}

/// The keys of `a` and `b` whose values differ, as paths: "/box/side".
void list_differences(const OrderedJson& a, const OrderedJson& b, const std::string& path,
                      std::vector<std::string>& differ) {
  if (a == b) return;
  if (!a.is_object() || !b.is_object()) {
    differ.push_back(path);
    return;
  }
  OrderedJson both = a;
  both.update(b);
  for (const auto& [key, value] : both.items()) {
    list_differences(a.value(key, OrderedJson()), b.value(key, OrderedJson()), fmt::format("{}/{}", path, key), differ);
  }
}

}  // namespace

Result<Tick> frame_spacing(const RecordedFrames& frames) {
  if (frames.n_frames() == 0) return Error{"there are no frames"};
  Tick spacing = 1, last = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(frames.n_frames(), 2); ++i) {
    const RecordedFrame frame = SHAKEN_TRY(frames.frame(i));
    if (i == 1) spacing = frame.tick - last;
    last = frame.tick;
  }
  if (spacing < 1) return Error{"the second frame is not later than the first"};
  if (last % spacing != 0 && frames.n_frames() > 1) {
    return Error{fmt::format("frames are {} ticks apart, and the first is not at a multiple of that", spacing)};
  }
  return spacing;
}

keys::Loaded<FramesPlan> plan_for_frames(const SceneText& of, const SceneText& asked,
                                         std::span<const std::string> settings, Tick spacing, const Lacking& lacking) {
  const auto own = SHAKEN_TRY(scene::load_scene(of.text, of.name));
  const auto wanted = SHAKEN_TRY(scene::load_scene(asked.text, asked.name, settings));
  OrderedJson scene = scene::to_json(wanted), simulated = scene::to_json(own);
  std::vector<std::string> differ;
  const auto simulation = [](OrderedJson json) {
    json["time"] = without(json["time"], kFreeOfTime);
    return without(std::move(json), kFree);
  };
  list_differences(simulation(simulated), simulation(scene), "", differ);
  std::vector<keys::Problem> problems;
  problems.reserve(differ.size());
  for (const std::string& path : differ) {
    problems.push_back(
        {asked.name, 0, 0, path, "is not that of the frames: only `measure` and `time.steady` may be another one"});
  }
  if (!problems.empty()) return problems;

  std::vector<std::string> remarks;
  const double dt = wanted.system.dt;
  bool is_any_left = false;
  OrderedJson& measure = scene["measure"];
  for (const MeasurementKind& kind : measurement_kinds()) {
    const auto block = measure.find(std::string(kind.name));
    if (block == measure.end() || !block->is_object()) continue;
    const auto need = std::ranges::find_if(kind.needs, [&](Needs each) { return lacking.contains(each); });
    if (need != kind.needs.end()) {
      remarks.push_back(fmt::format("measure.{} is left out: it needs {}", kind.name, word_of(*need)));
      measure.erase(block);
      continue;
    }
    is_any_left = true;
    const Tick period = Cadence(block->at("every").get<double>(), dt).period();
    const Tick whole = (period + spacing - 1) / spacing * spacing;
    if (whole != period) {
      (*block)["every"] = static_cast<double>(whole) * dt;
      remarks.push_back(fmt::format("measure.{}.every is {:.6g} s, not {:.6g} s: frames are {:.6g} s apart", kind.name,
                                    static_cast<double>(whole) * dt, static_cast<double>(period) * dt,
                                    static_cast<double>(spacing) * dt));
    }
    if (block->contains("phases")) (*block)["phases"] = "locked";
  }
  if (!is_any_left) {
    return std::vector<keys::Problem>{{asked.name, 0, 0, "/measure", "names nothing that frames tell"}};
  }
  return FramesPlan{SHAKEN_TRY(scene::load_scene(scene.dump(), asked.name)), std::move(remarks)};
}

Result<MeasuredFrames> measure_frames(const scene::RunPlan& plan, const RecordedFrames& frames,
                                      const std::function<bool(std::size_t frame)>& goes_on) {
  const Tick spacing = SHAKEN_TRY(frame_spacing(frames));
  const TrajectoryHeader& header = frames.header();
  Measurements measurements(plan, header.cell);
  MeasuredFrames found;
  Tick expected = 0;
  for (std::size_t i = 0; i < frames.n_frames(); ++i) {
    if (goes_on && !goes_on(i)) return Error{"interrupted", EINTR};
    const RecordedFrame recorded = SHAKEN_TRY(frames.frame(i));
    Snapshot frame = SHAKEN_TRY(decode(recorded, header.cell.box, !header.lacking.empty()));
    if (i > 0 && frame.tick != expected) {
      return Error{fmt::format("frame {} is at tick {}, where others are {} ticks apart", i, frame.tick, spacing)};
    }
    expected = frame.tick + spacing;
    frame.angular_velocity.assign(frame.n_rods(), Vec3::Zero());  // nothing that is measured has a part in it
    measurements.sample(frame);
    if (i == 0) found.first = frame.time;
    found.last = frame.time;
  }
  found.n_frames = frames.n_frames();
  found.reduction = measurements.reduce(found.last);
  return found;
}

Summary summary_of(const FramesPlan& by, const MeasuredFrames& found, const std::string& source) {
  Summary summary;
  summary.n_rods = by.plan.system.n_all_rods();
  summary.sim_seconds = found.last;
  fill(summary, by.plan, found.reduction);
  summary.frames = FramesOrigin{source, found.n_frames, found.first, found.last, by.remarks};
  summary.tick = static_cast<Tick>(std::llround(found.last / by.plan.system.dt));
  return summary;
}

}  // namespace shaken::run
