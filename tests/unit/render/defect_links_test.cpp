#include "render/defect_links.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/sources.h"
#include "render/view.h"
#include "tests/unit/render/render_support.h"

namespace shaken::render {
namespace {

constexpr double kSide = 20;

TEST(DefectLinks, TracksGoOnAcrossTheBorderAndHaveTheirAge) {
  DefectLinks links(analysis::Region(kSide, std::nullopt), 4);
  for (int k = 0; k <= 50; ++k) {
    std::vector<analysis::Defect> defects{{Vec2(std::fmod(15.0 + k, kSide), 5), 0.5, 0}};
    if (k >= 44) defects.push_back({Vec2(10, 15), -0.5, 0});
    links.add(0.1 * k, defects);
  }
  const auto trails = links.trails(5.0, 0.8);
  ASSERT_EQ(trails.size(), 2U);
  ASSERT_EQ(trails[0].places.size(), 9U) << "0.8 s, a frame each 0.1 s";
  EXPECT_NEAR(trails[0].places.front().position.x(), 57, 1e-9);
  EXPECT_NEAR(trails[0].places.front().age, 1, 1e-9);
  EXPECT_NEAR(trails[0].places.back().position.x(), 65, 1e-9) << "three times across the border";
  EXPECT_EQ(trails[0].places.back().age, 0);
  EXPECT_EQ(trails[1].charge, -0.5);
  EXPECT_EQ(trails[1].places.size(), 7U);
  EXPECT_EQ(links.trails(4.25, 0.8).size(), 1U) << "the other had not come yet";
}

TEST(DefectLinks, ATrailHasNoJumpsAndNothingBrief) {
  DefectLinks links(analysis::Region(40, std::nullopt), 4);
  for (int k = 0; k <= 20; ++k) {
    // 1 mm a frame; at frame 10 another defect, 3.5 mm away, takes the place: 70 mm/s.
    std::vector<analysis::Defect> defects{{Vec2(5 + 1.0 * k + (k >= 10 ? 2.5 : 0), 5), 0.5, 0}};
    if (k >= 5 && k < 8) defects.push_back({Vec2(30, 30), -0.5, 0});  // seen for 0.1 s
    links.add(0.05 * k, defects);
  }
  const std::vector<DefectTrail> trails = links.trails(1.0, 2.0);
  ASSERT_EQ(trails.size(), 2U);
  EXPECT_EQ(trails[0].places.size(), 10U);
  EXPECT_EQ(trails[1].places.size(), 11U);
  for (const DefectTrail& trail : trails) {
    EXPECT_EQ(trail.charge, 0.5);
    for (std::size_t k = 1; k < trail.places.size(); ++k) {
      EXPECT_LT((trail.places[k].position - trail.places[k - 1].position).norm(), 1.01);
    }
  }
}

TEST(DefectLinks, TheLongestLifeIsFirst) {
  DefectLinks links(analysis::Region(kSide, std::nullopt), 2);
  const Vec2 brief(3, 3), longer(14, 14);
  for (int k = 0; k <= 10; ++k) {
    std::vector<analysis::Defect> defects;
    if (k < 3) defects.push_back({brief, 0.5, 0});
    if (k >= 5) defects.push_back({longer + Vec2(0, 0.1 * k), 0.5, 0});
    links.add(k, defects);
  }
  EXPECT_EQ(links.count(0.5), 2U);
  const DefectLife life = links.longest(0.5, 0).value();
  EXPECT_EQ(life.at(8), longer + Vec2(0, 0.8));
  EXPECT_EQ(life.at(0), longer + Vec2(0, 0.5)) << "where it was born";
  EXPECT_EQ(life.at(99), longer + Vec2(0, 1.0));
  EXPECT_EQ(links.longest(0.5, 1)->at(0), brief);
  EXPECT_FALSE(links.longest(0.5, 2));
  EXPECT_FALSE(links.longest(-0.5, 0));
}

/// A box full of rods with a +1/2 at `plus` and a -1/2 half a box beside it; they move together, across the border.
RodPicture planted(const Vec2& plus) {
  RodPicture picture = empty_picture(40);
  const int n = 20;
  for (int i = 0; i < n * n; ++i) {
    const Vec2 at(2.0 * (i % n) + 1, 2.0 * (i / n) + 1);
    double angle = 0;
    for (int ky = -12; ky <= 12; ++ky) {
      for (int kx = -12; kx <= 12; ++kx) {
        const Vec2 shift(40.0 * kx, 40.0 * ky), a = at - plus - shift, b = a - Vec2(20, 0);
        angle += 0.5 * (std::atan2(a.y(), a.x()) - std::atan2(b.y(), b.x()));
      }
    }
    add_rod(picture, at.x(), at.y(), angle);
  }
  return picture;
}

TEST(Follow, APlantedPlusHalfStaysInTheMiddle) {
  const ScratchFolder folder;
  std::vector<RodPicture> frames;
  std::vector<Vec2> places;
  for (int k = 0; k < 12; ++k) {
    places.emplace_back(33.0 + 1.3 * k, 12.0 + 0.7 * k);
    frames.push_back(planted(places.back()));
    frames.back().frame.time = 0.1 * k;
  }
  plant_frames(folder.path(), frames);
  TrajectorySource source = TrajectorySource::open(folder.path()).value();
  PictureStyle style;
  style.width = style.height = 400;
  style.caption = style.legend = style.scale_bar = false;
  style.zoom = 4;
  style.followed_defect = FollowedDefect{0.5, 0};
  style.tracks = 0.5;
  ASSERT_TRUE(source.follow(*style.followed_defect, 0, 11));
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const RodPicture picture = source.picture(k, style).value();
    const Vec2 off = *picture.found.followed - places[k];
    // The director field is smoothed over a rod length.
    EXPECT_LT(std::hypot(std::remainder(off.x(), 40), std::remainder(off.y(), 40)), 1) << "frame " << k;
    // The white core of the comet is in the middle of the picture, and its rim is round it.
    const Image image = painter().paint(picture, style).value();
    EXPECT_GT(image.pixel(200, 200)[1], 250) << "frame " << k;
    ASSERT_EQ(picture.found.tracks.size(), k < 1 ? 0U : 2U) << "frame " << k;
    if (k < 1) continue;
    EXPECT_EQ(picture.found.tracks[0].places.size(), std::min<std::size_t>(k + 1, 6)) << "frame " << k;
  }
  const auto none = source.follow({0.5, 1}, 0, 11);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("in these frames there are 1"), std::string::npos) << none.error().message;
}

}  // namespace
}  // namespace shaken::render
