#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "run/export/frame_format.h"
#include "run/export/rod_angles.h"
#include "run/export/xyz_comment.h"
#include "run/files/quaternion.h"

namespace shaken::run {
namespace {

/// The species of a rod stands first, where readers of plain XYZ look for an element, and as a number: ASE takes a word
/// for the symbol of one, and refuses those it does not know.
constexpr const char* kRodColumns =
    "type:I:1:pos:R:3:id:I:1:orientation:R:4:aspherical_shape:R:3:map_shift:I:3:velo:R:3:director:R:3:theta:R:1";

/// Semi-axes of an ellipsoid about z that is as wide and as long as a rod.
struct SemiAxes {
  float across = 0;  ///< [mm]
  float along = 0;   ///< [mm]
};

SemiAxes semi_axes(const BeadRow& beads) {
  return {.across = static_cast<float>(*std::max_element(beads.radius.begin(), beads.radius.end())),
          .along = static_cast<float>(beads.reach())};
}

class ExtendedXyz final : public FrameFormat {
 public:
  explicit ExtendedXyz(const TrajectoryHeader& header) : header_(header), comment_(header, kRodColumns) {
    for (const BeadRow& beads : header_.cell.shapes) axes_.push_back(semi_axes(beads));
  }

  Result<void> begin(const Sink&) override { return {}; }

  Result<void> write(const RecordedFrame& frame, const Sink& sink) override {
    const auto n_rods = static_cast<std::size_t>(header_.n_rods);
    const std::vector<float> theta = rod_angles(header_, frame);
    text_.clear();
    const auto out = fmt::appender(text_);
    fmt::format_to(out, "{}\n{}\n", n_rods, comment_.of(frame));
    for (std::size_t i = 0; i < n_rods; ++i) {
      const float* x = &frame.position[3 * i];
      const float* q = &frame.orientation[4 * i];
      const float* v = &frame.velocity[3 * i];
      const std::int32_t* crossed = &frame.image[3 * i];
      const SemiAxes& axes = axes_[header_.cell.shape_of(i)];
      const Eigen::Vector3f n = director_of_quaternion({q[0], q[1], q[2], q[3]}).cast<float>();
      fmt::format_to(out, "{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}\n",
                     header_.cell.species_of(i) + 1, x[0], x[1], x[2], i, q[1], q[2], q[3], q[0], axes.across,
                     axes.across, axes.along, crossed[0], crossed[1], crossed[2], v[0], v[1], v[2], n.x(), n.y(), n.z(),
                     theta[i]);
    }
    return sink({text_.data(), text_.size()});
  }

 private:
  TrajectoryHeader header_;
  XyzComment comment_;
  std::vector<SemiAxes> axes_;  ///< of each shape
  fmt::memory_buffer text_;     ///< of one frame
};

}  // namespace

std::unique_ptr<FrameFormat> make_extended_xyz(const TrajectoryHeader& header) {
  return std::make_unique<ExtendedXyz>(header);
}

}  // namespace shaken::run
