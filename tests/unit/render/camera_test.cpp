#include "render/camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/colours.h"
#include "render/rods_pass.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace {

PictureStyle orbit(double azimuth, double elevation) {
  PictureStyle style;
  style.view = ViewPoint::kOrbit;
  style.orbit = Vec2(azimuth, elevation);
  style.colour = "species";  // the first is orange, nothing else is
  style.mark_defects = false;
  return style;
}

TEST(OrbitCamera, AxesAreAFrameAndTheBoxFits) {
  RodPicture picture = empty_picture(30);
  picture.cell.gap = 3;
  for (double azimuth = -360; azimuth <= 360; azimuth += 37) {
    for (const double elevation : {1.0, 20.0, 45.0, 89.0, 90.0}) {
      for (const double aspect : {0.5, 1.0, 2.2}) {
        const Camera camera = camera_of(picture, orbit(azimuth, elevation), aspect);
        EXPECT_NEAR(camera.right.cross(camera.forward).dot(camera.up), 1, 1e-12);
        EXPECT_GE(camera.up.z(), 0);
        double outermost = 0;
        for (int corner = 0; corner < 8; ++corner) {
          const Vec3 seen = camera.seen(Vec3((corner & 1) * 30, (corner >> 1 & 1) * 30, (corner >> 2) * 3));
          EXPECT_GT(seen.z(), camera.nearest);
          EXPECT_LT(seen.z(), camera.farthest);
          outermost = std::max({outermost, std::abs(seen.x()) / seen.z() / camera.half.x(),
                                std::abs(seen.y()) / seen.z() / camera.half.y()});
        }
        EXPECT_GT(outermost, 0.9) << azimuth << ' ' << elevation;
        EXPECT_LE(outermost, 1) << azimuth << ' ' << elevation;
      }
    }
  }
}

TEST(OrbitCamera, AzimuthNinetyIsFromTheRightAndElevationNinetyFromAbove) {
  const RodPicture picture = empty_picture(10);
  const Camera front = camera_of(picture, orbit(0, 30), 1), right = camera_of(picture, orbit(90, 30), 1),
               above = camera_of(picture, orbit(0, 90), 1);
  EXPECT_LT(front.eye.y(), 0);
  EXPECT_NEAR(front.eye.x(), 5, 1e-9);
  EXPECT_GT(right.eye.x(), 10);
  EXPECT_NEAR(right.eye.y(), 5, 1e-9);
  EXPECT_NEAR((above.forward - Vec3(0, 0, -1)).norm(), 0, 1e-9);
  EXPECT_NEAR((above.up - Vec3(0, 1, 0)).norm(), 0, 1e-9);
}

TEST(OrbitView, RodsAreSeenWhereTheyAreAndNowhereElse) {
  constexpr int kWidth = 640, kHeight = 480;
  RodsPass pass = RodsPass::create().value();
  for (const auto& [azimuth, elevation] : {std::pair{0.0, 20.0}, {-50.0, 35.0}, {130.0, 60.0}, {20.0, 90.0}}) {
    RodPicture picture = empty_picture(12);
    picture.cell.gap = 6;
    add_rod(picture, 4, 7, 0.7, 0.8);
    const PictureStyle style = orbit(azimuth, elevation);
    const Image image = pass.draw(picture, style, kWidth, kHeight).value();
    const Camera camera = camera_of(picture, style, double(kWidth) / kHeight);
    // A pixel is the rod's if its ray comes nearer to a bead's centre than that bead's radius: an obvious twin.
    int n_rod = 0, n_wrong = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const Vec3 ray = ((2 * (x + 0.5) / kWidth - 1) * camera.half.x() * camera.right +
                          (1 - 2 * (y + 0.5) / kHeight) * camera.half.y() * camera.up + camera.forward)
                             .normalized();
        double inside = -1e9;  // how deep in the body the ray goes [mm]
        const BeadRow& beads = picture.cell.shapes[0];
        for (std::size_t i = 0; i < beads.offset.size(); ++i) {
          const Vec3 centre = picture.frame.position[0] + beads.offset[i] * picture.frame.director[0] - camera.eye;
          inside = std::max(inside, beads.radius[i] - (centre - centre.dot(ray) * ray).norm());
        }
        const std::uint8_t* p = image.pixel(x, y);
        const bool is_rod = p[0] - p[2] > 25;
        n_rod += is_rod;
        n_wrong += std::abs(inside) > 2 * camera.pixel(kHeight) && is_rod != (inside > 0);
      }
    }
    EXPECT_GT(n_rod, 300) << azimuth;
    EXPECT_EQ(n_wrong, 0) << azimuth << ' ' << elevation;
  }
}

TEST(OrbitView, AroundThePlateThereIsNothing) {
  RodsPass pass = RodsPass::create().value();
  const RodPicture picture = empty_picture(12);
  const Image image = pass.draw(picture, orbit(0, 40), 300, 200).value();
  const PageColours colours = page_colours(Theme::kLight);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(image.pixel(3, 3)[c], 255 * colours.page[c], 1) << "beyond the plate";
    EXPECT_NEAR(image.pixel(296, 196)[c], 255 * colours.page[c], 1);
  }
  EXPECT_LT(image.pixel(160, 110)[0], 255 * colours.page[0] - 3) << "the plate";
}

}  // namespace
}  // namespace shaken::render
