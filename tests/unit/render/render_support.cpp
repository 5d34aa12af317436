#include "tests/unit/render/render_support.h"

#include <gtest/gtest.h>
#include <png.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "run/files/trajectory.h"
#include "tests/support/good.h"

namespace shaken::render {
namespace {

/// Nothing may be left in the home directory of who runs the tests.
const bool kNoShaderCache = setenv("MESA_SHADER_CACHE_DISABLE", "true", 1) == 0;

}  // namespace

RodPicture empty_picture(double box_side) {
  RodPicture picture;
  picture.cell.box = box_side;
  picture.cell.gap = 1.2;
  BeadRow& beads = picture.cell.shapes.emplace_back();
  for (int i = -7; i <= 7; ++i) {
    beads.offset.push_back(2.05 * i / 7);
    beads.radius.push_back(0.4 - 0.2 * std::abs(i) / 7);
  }
  return picture;
}

void add_rod(RodPicture& picture, double x, double y, double angle, double n_z) {
  const double flat = std::sqrt(1 - n_z * n_z);
  picture.frame.position.emplace_back(x, y, picture.cell.gap / 2);
  picture.frame.director.emplace_back(flat * std::cos(angle), flat * std::sin(angle), n_z);
}

double half_width(const RodPicture& picture, double x) {
  double widest = 0;
  for (std::size_t i = 0; i < picture.cell.shapes[0].offset.size(); ++i) {
    const double d = x - picture.cell.shapes[0].offset[i], r = picture.cell.shapes[0].radius[i];
    if (std::abs(d) < r) widest = std::max(widest, std::sqrt(r * r - d * d));
  }
  return widest;
}

Painter& painter() {
  static Painter shared = Painter::create().value();
  return shared;
}

Image read_png(const std::filesystem::path& file) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&png, file.c_str())) {
    ADD_FAILURE() << file << ": " << png.message;
    return {};
  }
  png.format = PNG_FORMAT_RGB;
  Image image(static_cast<int>(png.width), static_cast<int>(png.height));
  EXPECT_TRUE(png_image_finish_read(&png, nullptr, image.rgb.data(), 0, nullptr)) << png.message;
  return image;
}

std::string listing(const ScratchFolder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : " ") + name;
  return all;
}

void plant_frames(const std::filesystem::path& directory, const std::vector<RodPicture>& frames,
                  const std::string& scene_json) {
  RodPicture first = empty_picture(10);  // of a recording without frames
  add_rod(first, 5, 5, 0);
  if (!frames.empty()) first = frames.front();
  const run::TrajectoryHeader header{static_cast<int>(first.n_rods()), first.cell, 4e-6, scene_json, {}};
  const run::RunDirectory files{directory};
  Result<run::FrameLog> log = test::good(run::FrameLog::create(files.frames(), header));
  for (const RodPicture& rods : frames) {
    Snapshot snapshot;
    snapshot.tick = std::llround(rods.frame.time / header.dt);
    snapshot.time = rods.frame.time;
    snapshot.box = rods.cell.box;
    snapshot.position = rods.frame.position;
    snapshot.director = rods.frame.director;
    snapshot.image.resize(rods.n_rods());
    snapshot.velocity.assign(rods.n_rods(), Vec3::Zero());
    snapshot.angular_velocity.assign(rods.n_rods(), Vec3::Zero());
    (void)test::good(log->append(run::record(snapshot)));
  }
  const auto recorded = test::good(run::TrajectoryReader::open(files.frames()));
  ASSERT_TRUE(run::write_trajectory(files.trajectory(), recorded->recorded()));
  std::filesystem::remove(files.frames());
}

void plant_trajectory(const std::filesystem::path& directory, int n_frames, const std::string& scene_json) {
  std::vector<RodPicture> frames;
  for (int f = 0; f < n_frames; ++f) {
    RodPicture rods = empty_picture(10);
    rods.frame.time = f * 0.05;
    for (int i = 0; i < 3; ++i) add_rod(rods, 5, 2 + 3 * i, f * kPi / 18, 0.1);
    frames.push_back(std::move(rods));
  }
  plant_frames(directory, frames, scene_json);
}

}  // namespace shaken::render
