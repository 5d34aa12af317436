#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.h"
#include "base/core/types.h"
#include "run/files/recorded_frames.h"
#include "run/loop/summary.h"
#include "run/measure/measurement_kinds.h"
#include "run/measure/reduction.h"
#include "scene/keys/keys.h"
#include "scene/keys/run_plan.h"

namespace shaken::run {

/// What frames of runs do not tell.
inline const Lacking kLackingInFiles{Needs::kImpacts, Needs::kSpins};

/// A scene as a file or a header has it.
struct SceneText {
  std::string_view text;
  std::string name;  ///< in problems
};

/// By what recorded frames are measured.
struct FramesPlan {
  scene::RunPlan plan;
  std::vector<std::string> remarks;  ///< what is measured otherwise than was asked for, and why
};

/// Ticks from one frame to the next; 1 where there is but one. Fails if a frame cannot be read, or if frames are not
/// equally far apart, from a multiple of that distance on.
Result<Tick> frame_spacing(const RecordedFrames& frames);

/// The scene that frames are `of`, measured as `asked` and `settings` ("path=value") say, which may differ from it in
/// `measure` and `time.steady` only. Samples can be taken at frames alone: periods become whole multiples of `spacing`
/// [ticks], and samples are not spread over them. What needs something that the frames are `lacking` is left out.
keys::Loaded<FramesPlan> plan_for_frames(const SceneText& of, const SceneText& asked,
                                         std::span<const std::string> settings, Tick spacing,
                                         const Lacking& lacking = kLackingInFiles);

/// What came of recorded frames.
struct MeasuredFrames {
  Reduction reduction;
  double first = 0, last = 0;  ///< times of the first and the last frame [s]
  std::size_t n_frames = 0;
};

/// Measures what `plan` asks for, at each frame at which it is due; `goes_on` is asked at each frame. The files' single
/// precision is all that tells the results from those of the run. Fails if a frame is damaged.
Result<MeasuredFrames> measure_frames(const scene::RunPlan& plan, const RecordedFrames& frames,
                                      const std::function<bool(std::size_t frame)>& goes_on = {});

/// What summary.json says of them, but for its times and files. `source`: what the frames are of, as a user calls it.
Summary summary_of(const FramesPlan& by, const MeasuredFrames& found, const std::string& source);

}  // namespace shaken::run
