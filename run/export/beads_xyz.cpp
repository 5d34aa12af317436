#include <fmt/format.h>

#include "run/export/frame_format.h"
#include "run/export/xyz_comment.h"
#include "run/files/quaternion.h"

namespace shaken::run {
namespace {

constexpr const char* kBeadColumns = "species:S:1:pos:R:3:radius:R:1:molecule:I:1";

class BeadsXyz final : public FrameFormat {
 public:
  explicit BeadsXyz(const TrajectoryHeader& header) : header_(header), comment_(header, kBeadColumns) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(header_.n_rods); ++i) {
      n_beads_ += header_.cell.beads_of(i).radius.size();
    }
  }

  Result<void> begin(const Sink&) override { return {}; }

  Result<void> write(const RecordedFrame& frame, const Sink& sink) override {
    text_.clear();
    const auto out = fmt::appender(text_);
    fmt::format_to(out, "{}\n{}\n", n_beads_, comment_.of(frame));
    for (std::size_t i = 0; i < static_cast<std::size_t>(header_.n_rods); ++i) {
      const std::size_t species = header_.cell.species_of(i);
      const BeadRow& beads = header_.cell.beads_of(i);
      const float* q = &frame.orientation[4 * i];
      const Vec3 n = director_of_quaternion({q[0], q[1], q[2], q[3]});
      const Vec3 centre(frame.position[3 * i], frame.position[3 * i + 1], frame.position[3 * i + 2]);
      for (std::size_t b = 0; b < beads.radius.size(); ++b) {
        const Eigen::Vector3f x = (centre + beads.offset[b] * n).cast<float>();
        fmt::format_to(out, "{}{} {} {} {} {} {}\n", letter_of(species), b + 1, x.x(), x.y(), x.z(),
                       static_cast<float>(beads.radius[b]), i);
      }
    }
    return sink({text_.data(), text_.size()});
  }

 private:
  TrajectoryHeader header_;
  XyzComment comment_;
  std::size_t n_beads_ = 0;  ///< of all rods
  fmt::memory_buffer text_;  ///< of one frame
};

}  // namespace

std::unique_ptr<FrameFormat> make_beads_xyz(const TrajectoryHeader& header) {
  return std::make_unique<BeadsXyz>(header);
}

}  // namespace shaken::run
