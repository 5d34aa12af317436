#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "run/export/columns.h"
#include "run/export/frame_format.h"
#include "run/export/frames.h"
#include "run/export/rod_angles.h"
#include "run/files/frame_log.h"
#include "run/files/quaternion.h"

namespace shaken::run {
namespace {

using ::testing::HasSubstr;

/// A rod of three beads and one of two, which has no middle.
TrajectoryHeader two_species() {
  return {2,
          {.box = {10, 5},
           .gap = 1.5,
           .shapes = {{{-1, 0, 1}, {0.25, 0.5, 0.25}}, {{-0.5, 0.75}, {0.5, 0.25}}},
           .shape_of_rod = {0, 1}},
          0.25,
          R"({"plates": {"amplitude": 0.25}})",
          {"0123456789abcdef", 7}};
}

/// The first rod along x, the second along z.
RecordedFrame frame_of_two() {
  const float half = std::sqrt(0.5F);
  return {8, 2, {1, 2, 0.5, 9.5, 0.25, 1}, {1.5, -2, 0, 0, 0, 4}, {half, 0, half, 0, 1, 0, 0, 0}, {0, -1, 0, 3, 0, 0}};
}

/// The same rods, as two sizes of one species.
TrajectoryHeader two_sizes() {
  TrajectoryHeader header = two_species();
  header.cell.species_of_shape = {0, 0};
  return header;
}

/// All that a format makes of frames.
std::string text_of(FrameFormat& format, const std::vector<RecordedFrame>& frames) {
  std::string text;
  const Sink sink = [&](std::string_view bytes) -> Result<void> {
    text += bytes;
    return {};
  };
  EXPECT_TRUE(format.begin(sink));
  for (const RecordedFrame& frame : frames) EXPECT_TRUE(format.write(frame, sink));
  return text;
}

constexpr const char* kBox = R"(Lattice="10 0 0 0 5 0 0 0 2" Properties=)";

TEST(ExtendedXyz, HasOneLineForEachRod) {
  EXPECT_EQ(text_of(*make_extended_xyz(two_species()), {frame_of_two()}),
            std::string("2\n") + kBox +
                "type:I:1:pos:R:3:id:I:1:orientation:R:4:aspherical_shape:R:3:map_shift:I:3:velo:R:3:director:R:3:"
                "theta:R:1 "
                "pbc=\"T T F\" Time=2 Step=8 units=\"mm s\" source=\"Shaken run 0123456789abcdef seed 7\"\n"
                "1 1 2 0.5 0 0 0.70710677 0 0.70710677 0.5 0.5 1.25 0 -1 0 1.5 -2 0 1 0 0 0\n"
                "2 9.5 0.25 1 1 0 0 0 1 0.5 0.5 1 3 0 0 0 0 4 0 0 1 nan\n");
}

TEST(BeadsXyz, HasOneLineForEachBead) {
  EXPECT_EQ(text_of(*make_beads_xyz(two_species()), {frame_of_two()}),
            std::string("5\n") + kBox +
                "species:S:1:pos:R:3:radius:R:1:molecule:I:1 "
                "pbc=\"T T F\" Time=2 Step=8 units=\"mm s\" source=\"Shaken run 0123456789abcdef seed 7\"\n"
                "A1 0 2 0.5 0.25 0\n"
                "A2 1 2 0.5 0.5 0\n"
                "A3 2 2 0.5 0.25 0\n"
                "B1 9.5 0.25 0.5 0.5 1\n"
                "B2 9.5 0.25 1.75 0.25 1\n");
}

TEST(Xyz, SizesAreOfOneSpeciesWithBeadsOfTheirOwn) {
  const std::string rods = text_of(*make_extended_xyz(two_sizes()), {frame_of_two()});
  EXPECT_THAT(rods, HasSubstr("\n1 1 2 0.5 0 0 0.70710677 0 0.70710677 0.5 0.5 1.25 "));
  EXPECT_THAT(rods, HasSubstr("\n1 9.5 0.25 1 1 0 0 0 1 0.5 0.5 1 "));
  const std::string beads = text_of(*make_beads_xyz(two_sizes()), {frame_of_two()});
  EXPECT_THAT(beads, ::testing::EndsWith("A3 2 2 0.5 0.25 0\nA1 9.5 0.25 0.5 0.5 1\nA2 9.5 0.25 1.75 0.25 1\n"));
}

TEST(Xyz, FramesFollowEachOther) {
  const auto later = [](RecordedFrame frame) {
    frame.tick = 12;
    frame.time = 3;
    return frame;
  };
  for (const auto make : {make_extended_xyz, make_beads_xyz}) {
    const std::string both = text_of(*make(two_species()), {frame_of_two(), later(frame_of_two())});
    EXPECT_EQ(both,
              text_of(*make(two_species()), {frame_of_two()}) + text_of(*make(two_species()), {later(frame_of_two())}));
    EXPECT_THAT(both, HasSubstr(" Time=3 Step=12 "));
  }
}

TEST(Xyz, WallsAreNamedAndNothingIsPeriodicWithinThem) {
  TrajectoryHeader header = two_species();
  header.provenance = {};
  header.cell.walls = SideWalls{.arena = Arena::kAnnulus, .size = 8, .inner = 2.5};
  for (const auto make : {make_extended_xyz, make_beads_xyz}) {
    const std::string text = text_of(*make(header), {frame_of_two()});
    EXPECT_THAT(text, HasSubstr(" pbc=\"F F F\" Time=2 Step=8 units=\"mm s\" arena=annulus arena_size=8 "
                                "arena_inner=2.5\n"));
  }
  header.cell.walls = SideWalls{.arena = Arena::kStadium, .size = 6, .length = 2.5};
  EXPECT_THAT(text_of(*make_beads_xyz(header), {frame_of_two()}),
              HasSubstr(" pbc=\"F F F\" Time=2 Step=8 units=\"mm s\" arena=stadium arena_size=6 arena_length=2.5\n"));
  header.cell.walls = SideWalls{.arena = Arena::kWedge, .size = 6, .length = 2.5, .narrow = 1.5};
  EXPECT_THAT(text_of(*make_beads_xyz(header), {frame_of_two()}),
              HasSubstr(" arena=wedge arena_size=6 arena_length=2.5 arena_narrow=1.5\n"));
  header.cell.walls->arena = Arena::kEllipse;
  EXPECT_THAT(text_of(*make_beads_xyz(header), {frame_of_two()}),
              HasSubstr(" arena=ellipse arena_size=6 arena_length=2.5\n"));
  header.cell.walls->arena = Arena::kChannel;
  EXPECT_THAT(text_of(*make_beads_xyz(header), {frame_of_two()}), HasSubstr(" pbc=\"T F F\""));
  header.cell.walls->arena = Arena::kDisc;
  EXPECT_THAT(text_of(*make_beads_xyz(header), {frame_of_two()}), HasSubstr(" arena=disc arena_size=6\n"));
}

TEST(Xyz, ADamagedRunIdEndsNeitherTheLineNorItsQuotes) {
  TrajectoryHeader header = two_species();
  header.provenance.run_id = "01\n23\" x=\"\x1b";
  EXPECT_THAT(text_of(*make_beads_xyz(header), {frame_of_two()}),
              HasSubstr(" source=\"Shaken run 0123x seed 7\"\nA1 "));
}

TEST(Xyz, TheBoxIsAsHighAsPlatesGetThatMoveApart) {
  TrajectoryHeader header = two_species();
  header.scene_json =
      R"({"plates": {"amplitude": 0.25, "second": {"amplitude": 0.05}, "lid_motion": {"amplitude": 0.1}}})";
  EXPECT_THAT(text_of(*make_beads_xyz(header), {frame_of_two()}), HasSubstr("0 0 0 1.9\" "));
  header.scene_json = R"({"plates": {"amplitude": 0.25, "second": {"amplitude": 0.05}}})";
  EXPECT_THAT(text_of(*make_beads_xyz(header), {frame_of_two()}), HasSubstr("0 0 0 2.1\" "));
}

TEST(Xyz, WithoutAnAmplitudeTheBoxIsAsHighAsTheGap) {
  TrajectoryHeader header = two_species();
  for (const char* scene : {"", "no JSON", "{}", R"({"plates": {"amplitude": "much"}})"}) {
    header.scene_json = scene;
    EXPECT_THAT(text_of(*make_beads_xyz(header), {frame_of_two()}), HasSubstr("0 0 0 1.5\" ")) << scene;
  }
}

/// Files of the file layer as its specification has them, apart from anything that writes them.
class GsdFile {
 public:
  explicit GsdFile(std::string bytes) : bytes_(std::move(bytes)) {
    names_ = bytes_.substr(at<std::uint64_t>(24), 64 * at<std::uint64_t>(32));
    const auto index = at<std::uint64_t>(8);
    for (std::uint64_t e = 0; e < at<std::uint64_t>(16); ++e) {
      const std::size_t entry = index + 32 * e;
      if (at<std::int64_t>(entry + 16) == 0) break;
      entries_.push_back({at<std::uint64_t>(entry), at<std::uint64_t>(entry + 8), at<std::int64_t>(entry + 16),
                          at<std::uint32_t>(entry + 24), at<std::uint16_t>(entry + 28), at<std::uint8_t>(entry + 30),
                          at<std::uint8_t>(entry + 31)});
    }
  }

  struct Entry {
    std::uint64_t frame;
    std::uint64_t rows;
    std::int64_t location;
    std::uint32_t columns;
    std::uint16_t name;
    std::uint8_t type;
    std::uint8_t flags;
  };

  template <class Value>
  Value at(std::size_t place) const {
    Value value;
    EXPECT_LE(place + sizeof(value), bytes_.size());
    std::memcpy(&value, &bytes_.at(place), sizeof(value));
    return value;
  }
  std::string text(std::size_t place) const { return {&bytes_.at(place)}; }
  const std::vector<Entry>& entries() const { return entries_; }
  std::size_t size() const { return bytes_.size(); }

  std::string name(const Entry& entry) const {
    std::size_t begin = 0;
    for (int skipped = 0; skipped < entry.name; ++skipped) begin = names_.find('\0', begin) + 1;
    return {&names_.at(begin)};
  }
  /// None if this frame has no such array.
  template <class Value>
  std::vector<Value> array(std::uint64_t frame, const std::string& wanted, std::uint8_t type) const {
    for (const Entry& entry : entries_) {
      if (entry.frame != frame || name(entry) != wanted) continue;
      EXPECT_EQ(entry.type, type) << wanted;
      std::vector<Value> values(entry.rows * entry.columns);
      for (std::size_t k = 0; k < values.size(); ++k) {
        values[k] = at<Value>(static_cast<std::size_t>(entry.location) + k * sizeof(Value));
      }
      return values;
    }
    return {};
  }

 private:
  std::string bytes_;
  std::string names_;
  std::vector<Entry> entries_;
};

constexpr std::uint8_t kUint32 = 3, kUint64 = 4, kInt8 = 5, kInt32 = 7, kFloat = 9, kDouble = 10;

TEST(Gsd, BeginsAsItsSpecificationSays) {
  const GsdFile file(text_of(*make_gsd(two_species(), 1), {frame_of_two()}));
  EXPECT_EQ(file.at<std::uint64_t>(0), 0x65DF65DF65DF65DFU);
  EXPECT_EQ(file.at<std::uint32_t>(40), 0x00010004U);  // of the schema
  EXPECT_EQ(file.at<std::uint32_t>(44), 0x00020000U);  // of the file layer
  EXPECT_THAT(file.text(48), ::testing::StartsWith("Shaken "));
  EXPECT_EQ(file.text(112), "hoomd");
}

TEST(Gsd, HasATypeForEachSize) {
  const GsdFile file(text_of(*make_gsd(two_sizes(), 1), {frame_of_two()}));
  EXPECT_THAT(file.array<std::uint32_t>(0, "particles/typeid", kUint32), ::testing::ElementsAre(0U, 1U));
  EXPECT_THAT(file.array<char>(0, "particles/types", kInt8), ::testing::ElementsAre('A', '1', '\0', 'A', '2', '\0'));
}

/// Rods that lie at these angles, in degrees.
RecordedFrame frame_at(double first, double second) {
  RecordedFrame frame = frame_of_two();
  frame.orientation.clear();
  for (const double angle : {first, second}) {
    for (const double q : quaternion_of_director({std::cos(angle * kPi / 180), std::sin(angle * kPi / 180), 0}))
      frame.orientation.push_back(static_cast<float>(q));
  }
  return frame;
}

TEST(RodAngles, AreToTheDirectorOfTheFirstSpeciesWhichSpheresHaveNot) {
  const auto degrees = [](const TrajectoryHeader& header, double first, double second) {
    std::vector<float> found = rod_angles(header, frame_at(first, second));
    for (float& angle : found) angle *= static_cast<float>(180 / kPi);
    return found;
  };
  using ::testing::ElementsAre, ::testing::FloatNear, ::testing::IsNan;
  EXPECT_THAT(degrees(two_sizes(), 75, 105), ElementsAre(FloatNear(-15, 1e-4F), FloatNear(15, 1e-4F)));
  EXPECT_THAT(degrees(two_sizes(), 75, 285), ElementsAre(FloatNear(-15, 1e-4F), FloatNear(15, 1e-4F)));  // turned round
  EXPECT_THAT(degrees(two_species(), 75, 105), ElementsAre(FloatNear(0, 1e-4F), FloatNear(30, 1e-4F)));
  TrajectoryHeader spheres = two_species();
  spheres.cell.shapes[1] = {{0}, {0.5}};
  EXPECT_THAT(degrees(spheres, 75, 105), ElementsAre(FloatNear(0, 1e-4F), IsNan()));
  std::swap(spheres.cell.shapes[0], spheres.cell.shapes[1]);
  EXPECT_THAT(degrees(spheres, 75, 105), ElementsAre(IsNan(), IsNan()));
}

TEST(Gsd, HoldsTheRodsFromTheMiddleOfTheBox) {
  const GsdFile file(text_of(*make_gsd(two_species(), 1), {frame_of_two()}));
  const auto is = [](auto... values) { return ::testing::ElementsAre(values...); };
  EXPECT_THAT(file.array<std::uint64_t>(0, "configuration/step", kUint64), is(8U));
  EXPECT_THAT(file.array<float>(0, "configuration/box", kFloat), is(10.F, 5.F, 2.F, 0.F, 0.F, 0.F));
  EXPECT_THAT(file.array<std::uint32_t>(0, "particles/N", kUint32), is(2U));
  EXPECT_THAT(file.array<std::uint32_t>(0, "particles/typeid", kUint32), is(0U, 1U));
  EXPECT_THAT(file.array<float>(0, "particles/position", kFloat), is(-4.F, -0.5F, -0.5F, 4.5F, -2.25F, 0.F));
  EXPECT_EQ(file.array<float>(0, "particles/orientation", kFloat), frame_of_two().orientation);
  EXPECT_EQ(file.array<float>(0, "particles/velocity", kFloat), frame_of_two().velocity);
  EXPECT_EQ(file.array<std::int32_t>(0, "particles/image", kInt32), frame_of_two().image);
  EXPECT_THAT(file.array<float>(0, "log/particles/theta", kFloat), ::testing::ElementsAre(0.F, ::testing::IsNan()));
  EXPECT_THAT(file.array<double>(0, "log/time_s", kDouble), is(2.0));
  EXPECT_THAT(file.array<char>(0, "particles/types", kInt8), is('A', '\0', 'B', '\0'));

  const std::vector<char> shapes = file.array<char>(0, "particles/type_shapes", kInt8);
  using Json = nlohmann::json;
  const Json first = Json::parse(std::string(shapes.data()));
  EXPECT_EQ(first, Json::parse(R"({"type": "SphereUnion", "diameters": [0.5, 1, 0.5],
                                   "centers": [[0, 0, -1], [0, 0, 0], [0, 0, 1]]})"));
  const Json second = Json::parse(std::string(shapes.data() + shapes.size() / 2));
  EXPECT_EQ(second, Json::parse(R"({"type": "SphereUnion", "diameters": [1, 0.5],
                                    "centers": [[0, 0, -0.5], [0, 0, 0.75]]})"));
}

/// Frames of rods anywhere, some of them as near to the border as a float can be.
std::vector<RecordedFrame> random_frames(std::size_t n_frames, int n_rods, double side) {
  std::mt19937_64 rng(5);
  std::uniform_real_distribution<float> unit(0, 1);
  std::normal_distribution<float> normal;
  auto last = static_cast<float>(side);
  if (static_cast<double>(last) >= side) last = std::nextafter(last, 0.0F);
  std::vector<RecordedFrame> frames;
  for (std::size_t f = 0; f < n_frames; ++f) {
    RecordedFrame frame;
    frame.tick = static_cast<Tick>(100 * f);
    frame.time = 4e-6 * static_cast<double>(frame.tick);
    for (int i = 0; i < n_rods; ++i) {
      const float x = i % 7 == 0 ? last : std::min(last, unit(rng) * static_cast<float>(side));
      const float y = i % 5 == 0 ? 0 : std::min(last, unit(rng) * static_cast<float>(side));
      frame.position.insert(frame.position.end(), {x, y, unit(rng)});
      frame.velocity.insert(frame.velocity.end(), {normal(rng), normal(rng), normal(rng)});
      const Vec3 axis(normal(rng), normal(rng), normal(rng));
      for (const double q : quaternion_of_director(axis.normalized())) {
        frame.orientation.push_back(static_cast<float>(q));
      }
      frame.image.insert(frame.image.end(), {static_cast<std::int32_t>(10 * normal(rng)), i, 0});
    }
    frames.push_back(frame);
  }
  return frames;
}

TrajectoryHeader many_rods(double side) {
  return {50,
          {.box = side, .gap = 1.2, .shapes = {{{-1, 0, 1}, {0.2, 0.4, 0.2}}}},
          4e-6,
          R"({"plates": {"amplitude": 0.04}})",
          {}};
}

TEST(Gsd, ReadsBackAsItWas) {
  for (const double side : {10.0, 83.73, 100.1, 30.9}) {
    const TrajectoryHeader header = many_rods(side);
    const std::vector<RecordedFrame> frames = random_frames(9, header.n_rods, side);
    const GsdFile file(text_of(*make_gsd(header, frames.size()), frames));
    ASSERT_EQ(file.entries().size(), 5U + 7 * frames.size());
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const auto x = file.array<float>(f, "particles/position", kFloat);
      ASSERT_EQ(x.size(), frames[f].position.size());
      for (std::size_t k = 0; k < x.size(); ++k) {
        const double half = k % 3 == 2 ? 0.64 : side / 2;
        EXPECT_NEAR(x[k] + half, frames[f].position[k], 1.2e-7 * side) << side << " " << f << " " << k;
        if (k % 3 == 2) continue;
        EXPECT_GE(x[k], -static_cast<float>(side) / 2);
        EXPECT_LT(x[k], static_cast<float>(side) / 2) << side << " " << frames[f].position[k];
      }
      EXPECT_EQ(file.array<std::uint64_t>(f, "configuration/step", kUint64).at(0), 100 * f);
      EXPECT_EQ(file.array<double>(f, "log/time_s", kDouble).at(0), frames[f].time);
      EXPECT_EQ(file.array<float>(f, "particles/orientation", kFloat), frames[f].orientation);
      EXPECT_EQ(file.array<float>(f, "particles/velocity", kFloat), frames[f].velocity);
      EXPECT_EQ(file.array<std::int32_t>(f, "particles/image", kInt32), frames[f].image);
    }
  }
}

/// Readers look names up by halving the index, and refuse a file whose arrays do not lie within it.
TEST(Gsd, IndexIsSortedAndCoversTheFile) {
  const TrajectoryHeader header = many_rods(20);
  // more entries than are handed over at once
  const std::vector<RecordedFrame> frames = random_frames(1500, header.n_rods, 20);
  const GsdFile file(text_of(*make_gsd(header, frames.size()), frames));
  ASSERT_EQ(file.entries().size(), 5U + 7 * frames.size());
  EXPECT_EQ(file.at<std::uint64_t>(16), file.entries().size() + 1);  // one of zeros behind them
  auto end = static_cast<std::int64_t>(file.at<std::uint64_t>(8) + 32 * file.at<std::uint64_t>(16));
  for (std::size_t e = 0; e < file.entries().size(); ++e) {
    const GsdFile::Entry& entry = file.entries()[e];
    EXPECT_EQ(entry.location, end);
    const std::int64_t width = entry.type == kInt8 ? 1 : entry.type == kUint64 || entry.type == kDouble ? 8 : 4;
    end += static_cast<std::int64_t>(entry.rows * entry.columns) * width;
    EXPECT_EQ(entry.flags, 0);
    if (e == 0) continue;
    const GsdFile::Entry& before = file.entries()[e - 1];
    EXPECT_LT(std::pair(before.frame, before.name), std::pair(entry.frame, entry.name));
  }
  EXPECT_EQ(end, static_cast<std::int64_t>(file.size()));
}

/// What is held at a time does not grow with the number of frames.
TEST(FrameFormats, HandOverPiecesOfBoundedLength) {
  const TrajectoryHeader header = many_rods(20);
  const std::vector<RecordedFrame> one = random_frames(1, header.n_rods, 20);
  const auto longest_piece = [&](FrameFormat& format, std::size_t n_frames) {
    std::size_t longest = 0;
    const Sink sink = [&](std::string_view bytes) -> Result<void> {
      longest = std::max(longest, bytes.size());
      return {};
    };
    EXPECT_TRUE(format.begin(sink));
    for (std::size_t f = 0; f < n_frames; ++f) EXPECT_TRUE(format.write(one.front(), sink));
    return longest;
  };
  for (const auto make : {make_extended_xyz, make_beads_xyz}) {
    EXPECT_EQ(longest_piece(*make(header), 2), longest_piece(*make(header), 500));
  }
  EXPECT_EQ(longest_piece(*make_gsd(header, 5000), 5000), longest_piece(*make_gsd(header, 20000), 20000));
}

TEST(FrameFormats, PassOnThatTheSinkRefuses) {
  const Sink refuses = [](std::string_view) -> Result<void> { return Error{"no room"}; };
  EXPECT_EQ(make_extended_xyz(two_species())->write(frame_of_two(), refuses).error().message, "no room");
  EXPECT_EQ(make_beads_xyz(two_species())->write(frame_of_two(), refuses).error().message, "no room");
  EXPECT_EQ(make_gsd(two_species(), 1)->begin(refuses).error().message, "no room");
}

/// A log of 21 frames, every 0.01 s from 0 to 0.2 s.
class ExportedFrames : public ::testing::Test {
 protected:
  ExportedFrames() {
    auto log = FrameLog::create(file_, many_rods(20));
    EXPECT_TRUE(log) << log.error().message;
    std::vector<RecordedFrame> frames = random_frames(21, 50, 20);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      frames[f].tick = static_cast<Tick>(2500 * f);
      frames[f].time = 4e-6 * static_cast<double>(frames[f].tick);
      EXPECT_TRUE(log->append(frames[f]));
    }
  }
  TrajectoryReader open() const {
    auto trajectory = TrajectoryReader::open(file_);
    EXPECT_TRUE(trajectory) << trajectory.error().message;
    return std::move(*trajectory);
  }
  /// Indices of the frames found.
  std::vector<std::size_t> find(const WantedFrames& wanted) const {
    const auto range = find_frames(open(), wanted);
    EXPECT_TRUE(range) << range.error().message;
    std::vector<std::size_t> found;
    for (std::size_t i = range->first; i < range->end; i += range->every) found.push_back(i);
    EXPECT_EQ(found.size(), range->size());
    return found;
  }

  ScratchFolder folder_;
  std::filesystem::path file_ = folder_ / "trajectory.part";
};

TEST_F(ExportedFrames, AreChosenByTimeAndNumber) {
  using ::testing::ElementsAre;
  EXPECT_EQ(find({}).size(), 21U);
  EXPECT_THAT(find({.from = 0.17}), ElementsAre(17, 18, 19, 20));
  EXPECT_THAT(find({.to = 0.02}), ElementsAre(0, 1, 2));
  EXPECT_THAT(find({.from = 0.081, .to = 0.109}), ElementsAre(9, 10));
  EXPECT_THAT(find({.from = 0.2, .to = 0.2}), ElementsAre(20));
  EXPECT_THAT(find({.from = 0.1, .every = 4}), ElementsAre(10, 14, 18));
  EXPECT_THAT(find({.every = 1000}), ElementsAre(0));
  EXPECT_THAT(find({.only_last = true}), ElementsAre(20));
  EXPECT_THAT(find({.to = 0.15, .every = 10, .only_last = true}), ElementsAre(10));
  EXPECT_THAT(find({.from = -1, .to = 1e9, .every = 7}), ElementsAre(0, 7, 14));
  // 0.07 / 4e-6 is not whole in floating point
  EXPECT_THAT(find({.from = 0.07, .to = 0.07}), ElementsAre(7));
}

TEST_F(ExportedFrames, AreRefusedWhereThereAreNone) {
  for (const WantedFrames& wanted : {WantedFrames{.from = 0.3}, WantedFrames{.to = -0.1},
                                     WantedFrames{.from = 0.012, .to = 0.018}, WantedFrames{.from = 0.2, .to = 0.1}}) {
    const auto range = find_frames(open(), wanted);
    ASSERT_FALSE(range);
    EXPECT_EQ(range.error().message, "there is no such frame: the 21 frames are from 0 s to 0.2 s");
  }
  ASSERT_TRUE(FrameLog::create(file_, many_rods(20)));
  EXPECT_EQ(find_frames(open(), {}).error().message, "no frame is recorded yet");
}

TEST_F(ExportedFrames, AreThoseOfTheTrajectory) {
  const TrajectoryReader trajectory = open();
  std::string text;
  const Sink sink = [&](std::string_view bytes) -> Result<void> {
    text += bytes;
    return {};
  };
  const auto format = make_gsd(trajectory.header(), 3);
  const auto n = export_frames(trajectory, {2, 21, 8}, *format, sink, [](std::size_t) { return true; });
  ASSERT_TRUE(n) << n.error().message;
  EXPECT_EQ(*n, 3U);
  const GsdFile file(text);
  for (std::size_t f = 0; f < 3; ++f) {
    const auto frame = trajectory.recorded().frame(2 + 8 * f);
    EXPECT_EQ(file.array<float>(f, "particles/velocity", kFloat), frame->velocity);
    EXPECT_EQ(file.array<std::uint64_t>(f, "configuration/step", kUint64).at(0), 2500 * (2 + 8 * f));
  }
}

TEST_F(ExportedFrames, EndWhereTheCallerSaysSo) {
  const TrajectoryReader trajectory = open();
  const auto format = make_beads_xyz(trajectory.header());
  int n_pieces = 0;
  const Sink sink = [&](std::string_view) -> Result<void> {
    ++n_pieces;
    return {};
  };
  const auto n = export_frames(trajectory, {0, 21, 1}, *format, sink, [](std::size_t n_done) { return n_done < 4; });
  ASSERT_TRUE(n);
  EXPECT_EQ(*n, 4U);
  EXPECT_EQ(n_pieces, 4);
}

Observables some_arrays() {
  const double nan = std::nan("");
  return {{"/order/time_s", {0, 0.5}},       {"/order/order", {0.25, nan}},     {"/order/director_rad", {1e-7, -3}},
          {"/order/pdf/density", {1, 2, 3}}, {"/order/pdf/order", {0, 0.5, 1}}, {"/rods/trace/time_s", {0, 1}},
          {"/rods/trace/12/x_mm", {4, 5}},   {"/rods/trace/12/n_z", {6, 7}},    {"/pairs/across_mm", {-1, 1}},
          {"/pairs/along_mm", {10, 20, 30}}, {"/pairs/g", {1, 2, 3, 4, 5, 6}}};
}

TEST(ObservablesCsv, AGroupIsATable) {
  EXPECT_EQ(*observables_csv(some_arrays(), {"order"}), "time_s,order,director_rad\n0,0.25,1e-07\n0.5,,-3\n");
  EXPECT_EQ(*observables_csv(some_arrays(), {"/order/pdf/"}), "order,density\n0,1\n0.5,2\n1,3\n");
}

TEST(ObservablesCsv, SeveralNamesMakeOneTable) {
  EXPECT_EQ(*observables_csv(some_arrays(), {"order/order"}), "order\n0.25\n\n");
  EXPECT_EQ(*observables_csv(some_arrays(), {"rods/trace", "rods/trace/12"}), "time_s,12/x_mm,12/n_z\n0,4,6\n1,5,7\n");
  EXPECT_EQ(*observables_csv(some_arrays(), {"rods/trace/time_s", "order/order", "order/order"}),
            "rods/trace/time_s,order/order\n0,0.25\n1,\n");
}

TEST(ObservablesCsv, AMapHasALineForEachPoint) {
  EXPECT_EQ(*observables_csv(some_arrays(), {"pairs"}),
            "along_mm,across_mm,g\n10,-1,1\n20,-1,2\n30,-1,3\n10,1,4\n20,1,5\n30,1,6\n");
  EXPECT_EQ(*observables_csv(some_arrays(), {"pairs/g"}), *observables_csv(some_arrays(), {"pairs"}));
}

TEST(ObservablesCsv, MapsOfAllKindsHaveTheirPlaces) {
  const Observables arrays{{"/scattering/q_per_mm", {1, 2}},
                           {"/scattering/lag_s", {10, 20}},
                           {"/scattering/f", {1, 2, 3, 4}},
                           {"/scattering/alpha_2", {7, 8}},
                           {"/van_hove/lag_s", {5, 6}},
                           {"/van_hove/displacement_mm", {0.1, 0.2, 0.3, 0.4, 0.6, 0.8}},
                           {"/van_hove/along_per_mm", {1, 2, 3, 4, 5, 6}},
                           {"/rods_2/density/time_s", {0, 1}},
                           {"/rods_2/density/x_mm", {3}},
                           {"/rods_2/density/y_mm", {4, 5}},
                           {"/rods_2/density/area_fraction", {1, 2, 3, 4}},
                           {"/rods_2/density/mean_area_fraction", {8, 9}},
                           {"/rods_2/density/memory/lag_s", {1, 2}},
                           {"/defect_maps/along_mm", {1, 2}},
                           {"/defect_maps/across_mm", {3, 4}},
                           {"/defect_maps/plus/density", {1, 2, 3, 4}},
                           {"/defect_maps/minus/density", {5, 6, 7, 8}}};
  const auto csv = [&](const char* name) { return *observables_csv(arrays, {name}); };
  EXPECT_EQ(csv("scattering"), "lag_s,q_per_mm,f,alpha_2\n10,1,1,7\n20,1,2,8\n10,2,3,7\n20,2,4,8\n");
  EXPECT_EQ(csv("scattering/alpha_2"), "alpha_2\n7\n8\n");
  EXPECT_EQ(csv("van_hove/along_per_mm"),
            "displacement_mm,lag_s,along_per_mm\n0.1,5,1\n0.2,5,2\n0.3,5,3\n0.4,6,4\n0.6,6,5\n0.8,6,6\n");
  EXPECT_EQ(csv("rods_2/density"),
            "x_mm,y_mm,time_s,area_fraction,mean_area_fraction\n3,4,0,1,8\n3,5,0,2,9\n3,4,1,3,8\n3,5,1,4,9\n");
  EXPECT_EQ(csv("rods_2/density/mean_area_fraction"), "x_mm,y_mm,mean_area_fraction\n3,4,8\n3,5,9\n");
  EXPECT_EQ(csv("defect_maps"), "along_mm,across_mm,plus/density,minus/density\n1,3,1,5\n2,3,2,6\n1,4,3,7\n2,4,4,8\n");
  EXPECT_EQ(csv("defect_maps/minus"), "along_mm,across_mm,minus/density\n1,3,5\n2,3,6\n1,4,7\n2,4,8\n");
}

TEST(ObservablesCsv, RefusesEverythingAtOnce) {
  const auto table = observables_csv(some_arrays(), {"ordre", "order/order", "order/pdf/density", "/\x1b"});
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().message,
            "no array or group of observables is called 'ordre'\n"
            "no array or group of observables is called '/\\u001b'\n"
            "arrays of different lengths make no table; name those of one length:\n"
            "  order/order has 2\n"
            "  order/pdf/density has 3");
  EXPECT_EQ(observables_csv(some_arrays(), {}).error().message, "no observable is named");
  EXPECT_THAT(observables_csv(some_arrays(), {"order/ordre"}).error().message, HasSubstr("is called"));
  for (const char* name : {"msd", "/msd/total_mm2"}) {
    EXPECT_EQ(
        observables_csv(some_arrays(), {name}).error().message,
        "'" + std::string(name) + "' was not measured in this run: its scene has no measure.msd, or its rods no axis");
  }
}

TEST(ObservablesCsv, ListSaysWhatCanBeNamed) {
  Observables arrays = some_arrays();
  std::erase_if(arrays, [](const auto& array) { return !array.first.starts_with("/order"); });
  EXPECT_EQ(observables_list(arrays),
            "order\n"
            "  order/time_s                                    2 values in s\n"
            "  order/order                                     2 values\n"
            "  order/director_rad                              2 values in rad\n"
            "order/pdf\n"
            "  order/pdf/order                                 3 values\n"
            "  order/pdf/density                               3 values\n");
}

TEST(SummaryCsv, HasALineForEachNumber) {
  const auto table = summary_csv(R"({"run_id": "01", "n_rods": 60, "collisions": {"rod_rod": 7}, "steady": true,
    "order": {"mean": 0.75, "std": 0.125, "sem": 0.01, "tau_s": 0.5, "t_steady_s": 1, "n_effective": 9.5,
              "steady": true, "drift": {"value": 1, "sem": 2}},
    "defects": null,
    "measured": {"theta_m_deg": {"value": 30.5, "sem": null, "n_effective": 4, "steady": false},
                 "velocity_rms_mm_s": {"value": 2.5, "over_s": 0.4},
                 "alpha": {"value": null, "reason": "too short"}}})");
  ASSERT_TRUE(table);
  EXPECT_EQ(*table,
            "name,value,sem,n_effective,steady,over_s\n"
            "n_rods,60,,,,\n"
            "collisions.rod_rod,7,,,,\n"
            "order,0.75,0.01,9.5,true,\n"
            "order.std,0.125,,,,\n"
            "order.tau_s,0.5,,,,\n"
            "order.t_steady_s,1,,,,\n"
            "theta_m_deg,30.5,,4,false,\n"
            "velocity_rms_mm_s,2.5,,,,0.4\n"
            "alpha,,,,,\n");
  EXPECT_FALSE(summary_csv("[1]"));
  EXPECT_FALSE(summary_csv("{"));
}

}  // namespace
}  // namespace shaken::run
