#include "run/files/trajectory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include "base/files.h"
#include "base/scratch_folder.h"
#include "run/files/version.h"
#include "tests/support/good.h"
#include "tests/support/in_child.h"
#include "tests/unit/run/hdf5_attributes.h"

namespace shaken::run {
namespace {

constexpr double kSide = 83.73;
constexpr double kHigh = 41.1;  // not kSide times a number
constexpr double kGap = 1.2;
constexpr double kDt = 4e-6;
constexpr int kRods = 300;

TrajectoryHeader header() {
  return {kRods,
          {.box = {kSide, kHigh}, .gap = kGap, .shapes = {{{-2.05, 0, 2.05}, {0.2, 0.4, 0.2}}}},
          kDt,
          R"({"rods": {"count": 300}})",
          {"0123456789abcdef", 77}};
}

Snapshot snapshot(Tick tick) {
  std::mt19937_64 rng(static_cast<std::uint64_t>(tick) + 1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  Snapshot s;
  s.tick = tick;
  s.time = static_cast<double>(tick) * kDt;
  s.box = {kSide, kHigh};
  for (int i = 0; i < kRods; ++i) {
    s.position.emplace_back(kSide * unit(rng), kHigh * unit(rng), kGap * unit(rng));
    s.director.push_back(Vec3{normal(rng), normal(rng), normal(rng)}.normalized());
    s.velocity.emplace_back(10 * normal(rng), 10 * normal(rng), 100 * normal(rng));
    s.angular_velocity.emplace_back(0, 0, 0);
    s.image.push_back({static_cast<std::int32_t>(normal(rng) * 100), static_cast<std::int32_t>(tick)});
  }
  return s;
}

void expect_same(const Snapshot& frame, const Snapshot& s) {
  EXPECT_EQ(frame.tick, s.tick);
  EXPECT_EQ(frame.time, s.time);
  ASSERT_EQ(frame.position.size(), s.n_rods());
  for (std::size_t i = 0; i < s.n_rods(); ++i) {
    EXPECT_LT((frame.position[i] - s.position[i]).norm(), kSide * 1.2e-7) << i;  // float32
    EXPECT_LT((frame.director[i] - s.director[i]).norm(), 5e-7) << i;
    EXPECT_LT((frame.velocity[i] - s.velocity[i]).norm(), 1e-7 * (1 + s.velocity[i].norm())) << i;
    EXPECT_NEAR(frame.director[i].norm(), 1, 1e-15);
    EXPECT_EQ(frame.image[i], s.image[i]);
  }
}

/// A log of frames at ticks 0, 1000, 2000 ...
std::filesystem::path write_log(const ScratchFolder& folder, Tick n_frames, const TrajectoryHeader& of = header()) {
  const auto file = folder / "trajectory.part";
  auto log = test::good(FrameLog::create(file, of));
  for (Tick i = 0; i < n_frames; ++i) EXPECT_TRUE(log->append(record(snapshot(1000 * i))));
  return file;
}

/// trajectory.h5 of such a log.
std::filesystem::path write_frames(const ScratchFolder& folder, Tick n_frames, const TrajectoryHeader& of = header()) {
  const auto file = folder / "trajectory.h5";
  const auto frames = test::good(TrajectoryReader::open(write_log(folder, n_frames, of)));
  const auto done = test::good(write_trajectory(file, frames->recorded()));
  return file;
}

void expect_same(const TrajectoryHeader& a, const TrajectoryHeader& b) {
  EXPECT_EQ(a.n_rods, b.n_rods);
  EXPECT_EQ(a.cell, b.cell);
  EXPECT_EQ(a.dt, b.dt);
  EXPECT_EQ(a.scene_json, b.scene_json);
  EXPECT_EQ(a.provenance.run_id, b.provenance.run_id);
  EXPECT_EQ(a.provenance.seed, b.provenance.seed);
}

/// Both kinds of file.
void expect_frames(const ScratchFolder& folder, Tick n_frames, const TrajectoryHeader& of) {
  for (const auto& file : {write_log(folder, n_frames, of), write_frames(folder, n_frames, of)}) {
    const auto reader = test::good(TrajectoryReader::open(file));
    expect_same(reader->header(), of);
    ASSERT_EQ(reader->n_frames(), static_cast<std::size_t>(n_frames));
    for (Tick i = 0; i < n_frames; ++i) {
      const auto frame = test::good(reader->frame(static_cast<std::size_t>(i)));
      expect_same(*frame, snapshot(1000 * i));
    }
    EXPECT_FALSE(reader->frame(static_cast<std::size_t>(n_frames)));
  }
}

TEST(Trajectory, ComesBackAsWritten) {
  const ScratchFolder folder;
  expect_frames(folder, 3, header());
  expect_frames(folder, 0, header());
}

TEST(Trajectory, SpeciesAndSideWallsComeBack) {
  const ScratchFolder folder;
  TrajectoryHeader several = header();
  several.cell.gap = 0.1 + 0.2;  // no short decimal
  several.cell.shapes.push_back({{0}, {0.45}});
  several.cell.shapes.push_back({{-1.2, 0.1, 1.4}, {0.45, 1.0 / 3, 0.2}});
  for (int i = 0; i < kRods; ++i)
    several.cell.shape_of_rod.push_back(static_cast<std::uint8_t>(i % 7 == 0 ? 1 : i % 5 == 0 ? 2 : 0));
  for (const auto& [name, arena] : kArenaNames) {
    several.cell.walls = SideWalls{.arena = arena, .size = 70.25, .contact = {0.02, 0.7}};
    if (arena == Arena::kAnnulus) several.cell.walls->inner = 12.5;
    if (several.cell.walls->has_length()) several.cell.walls->length = arena == Arena::kEllipse ? 80.125 : 3.125;
    if (arena == Arena::kWedge) several.cell.walls->narrow = 1.0 / 3;
    expect_frames(folder, 2, several);
  }
}

TEST(Trajectory, SizesOfSpeciesComeBack) {
  const ScratchFolder folder;
  TrajectoryHeader several = header();
  several.cell.shapes.push_back({{-2.25, 0, 2.25}, {0.2, 0.4, 0.2}});
  several.cell.species_of_shape = {0, 0};
  for (int i = 0; i < kRods; ++i) several.cell.shape_of_rod.push_back(static_cast<std::uint8_t>(i % 2));
  expect_frames(folder, 2, several);
  several.cell.shapes.push_back({{0}, {0.45}});
  several.cell.species_of_shape.push_back(1);
  several.cell.shape_of_rod[3] = 2;
  expect_frames(folder, 2, several);
  for (const std::vector<std::uint8_t>& wrong :
       {std::vector<std::uint8_t>{0, 0}, {0, 0, 2}, {1, 1, 1}, {0, 1, 0}, {0, 0, 0, 0}}) {
    several.cell.species_of_shape = wrong;
    EXPECT_THAT(test::refusal(FrameLog::create(folder / "t.part", several)),
                testing::HasSubstr("contradict the species"));
  }
}

TEST(Trajectory, PostsComeBack) {
  const ScratchFolder folder;
  TrajectoryHeader among = header();
  among.cell.posts = {.diameter = 1.0 / 3, .centres = {{0.1, 0.2}, {1.0 / 7, kSide / 3}, {3, 1}}};
  expect_frames(folder, 2, among);
  among.cell.posts.centres.emplace_back(kSide + 1, 2);
  EXPECT_THAT(test::refusal(FrameLog::create(folder / "t.part", among)),
              testing::HasSubstr("a post outside of the box"));
}

TEST(Trajectory, ASpeciesWithoutBeadsIsRefused) {
  const ScratchFolder folder;
  TrajectoryHeader several = header();
  several.cell.shapes.push_back({{0}, {0.45}});
  several.cell.shape_of_rod.assign(kRods, 2);
  EXPECT_THAT(test::refusal(FrameLog::create(folder / "t.part", several)), testing::HasSubstr("beads are not there"));
  several.cell.shape_of_rod.assign(kRods - 1, 1);
  EXPECT_FALSE(FrameLog::create(folder / "t.part", several)) << "a species for each rod";
}

TEST(RecordedFrame, PositionsStayInTheBoxWhenRounded) {
  Snapshot s = snapshot(0);
  s.position[0] = Vec3(std::nextafter(kSide, 0.0), kSide - 1e-7, 0.6);
  const auto frame = decode(record(s), s.box);
  EXPECT_LT(frame->position[0].x(), kSide);
  EXPECT_LT(frame->position[0].y(), kSide);
  EXPECT_NEAR(frame->position[0].x(), kSide, 1e-5);
}

TEST(RecordedFrame, DirectorsKeepTheirSignAlsoNearThePoles) {
  Snapshot s = snapshot(0);
  const std::vector<Vec3> special{{0, 0, 1},  {0, 0, -1},    {1, 0, 0},     {-1, 0, 0},    {0, 1, 0},
                                  {0, -1, 0}, {1e-5, 0, -1}, {0, -1e-4, 1}, {-1e-9, 0, -1}};
  for (std::size_t i = 0; i < special.size(); ++i) s.director[i] = special[i].normalized();
  expect_same(*decode(record(s), s.box), s);
}

TEST(RecordedFrame, AnOrientationThatIsNoneIsRefused) {
  RecordedFrame frame = record(snapshot(0));
  for (std::size_t k = 0; k < 4; ++k) frame.orientation[4 * 7 + k] = 0;
  EXPECT_THAT(test::refusal(decode(frame, {kSide, kHigh})), testing::HasSubstr("rod 7"));
}

// Loops that fold a place into the box never end with such numbers, and drawing takes NaN for black.
TEST(RecordedFrame, ANumberThatNoRodCanHaveIsRefusedWithItsRod) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {kInfinity, -kInfinity, kNan, 1e30F}) {
    for (const std::size_t k : {0U, 1U, 2U}) {
      RecordedFrame frame = record(snapshot(0));
      frame.position[3 * 7 + k] = bad;
      EXPECT_THAT(test::refusal(decode(frame, {kSide, kHigh})),
                  testing::HasSubstr(k < 2 ? "the position of rod 7 is" : "the height of rod 7 is"))
          << bad << " " << k;
      frame = record(snapshot(0));
      frame.velocity[3 * 7 + k] = bad;
      EXPECT_FALSE(decode(frame, {kSide, kHigh})) << bad << " " << k;
    }
    RecordedFrame frame = record(snapshot(0));
    frame.time = bad;
    if (bad != 1e30F) {
      EXPECT_FALSE(decode(frame, {kSide, kHigh})) << bad;
    }
  }
}

TEST(Trajectory, LengthsThatAreNoneAreRefused) {
  for (const double bad :
       {0.0, -1.0, 1e30, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    TrajectoryHeader of = header();
    of.cell.box = bad;
    EXPECT_FALSE(check(of)) << bad;
    of = header();
    of.cell.gap = bad;
    EXPECT_FALSE(check(of)) << bad;
    of = header();
    of.cell.shapes[0].radius.back() = bad;
    EXPECT_FALSE(check(of)) << bad;
  }
  TrajectoryHeader of = header();
  of.cell.shapes[0].offset.pop_back();
  EXPECT_FALSE(check(of));
  EXPECT_TRUE(check(header()));
}

TEST(FrameLog, CanBeReadWhileItGrows) {
  const ScratchFolder folder;
  auto log = FrameLog::create(folder / "t.part", header());
  for (Tick i = 0; i < 4; ++i) {
    const auto reader = test::good(TrajectoryReader::open(folder / "t.part"));
    EXPECT_EQ(reader->n_frames(), static_cast<std::size_t>(i));
    ASSERT_TRUE(log->append(record(snapshot(i))));
  }
}

TEST(FrameLog, SurvivesTheWritersSuddenEnd) {
  const ScratchFolder folder;
  EXPECT_EQ(in_child([&] {
              auto log = FrameLog::create(folder / "t.part", header());
              for (Tick i = 0; i < 5; ++i) {
                if (!log->append(record(snapshot(i)))) return false;
              }
              kill(getpid(), SIGKILL);
              return true;
            }),
            128);
  const auto reader = test::good(TrajectoryReader::open(folder / "t.part"));
  ASSERT_EQ(reader->n_frames(), 5U);
  expect_same(*reader->frame(4), snapshot(4));
}

TEST(FrameLog, ReopeningCutsWhatCameAfterTheCheckpoint) {
  const ScratchFolder folder;
  const auto file = write_log(folder, 5);
  {
    auto log = test::good(FrameLog::reopen(file, 3));
    EXPECT_EQ(log->n_frames(), 3U);
    ASSERT_TRUE(log->append(record(snapshot(2700))));
    EXPECT_EQ(log->n_frames(), 4U);
  }
  const auto reader = TrajectoryReader::open(file);
  ASSERT_EQ(reader->n_frames(), 4U);
  expect_same(*reader->frame(2), snapshot(2000));
  expect_same(*reader->frame(3), snapshot(2700));
}

/// What a killed writer, or a machine without power, leaves of the last frame: any part of it.
TEST(FrameLog, HalfAFrameIsLeftOutAndCut) {
  const ScratchFolder folder;
  const std::string two = *read_file(write_log(folder, 2)), three = *read_file(write_log(folder, 3));
  const auto file = folder / "torn.part";
  for (std::size_t size = two.size(); size < three.size(); size += 211) {
    for (const char fill : {'\0', 'x'}) {  // nothing follows, or blocks that were never written
      std::string torn = three.substr(0, size);
      if (fill == '\0') torn.resize(three.size(), fill);
      ASSERT_TRUE(write_file_atomically(file, torn));
      EXPECT_EQ(TrajectoryReader::open(file)->n_frames(), 2U) << size;
      EXPECT_FALSE(FrameLog::reopen(file, 3)) << size;
      EXPECT_EQ(std::filesystem::file_size(file), torn.size()) << "refused, and left as it is";
      auto log = test::good(FrameLog::reopen(file, 2));
      ASSERT_TRUE(log->append(record(snapshot(2000))));
      EXPECT_EQ(*read_file(file), three) << size;
    }
  }
  ASSERT_TRUE(write_file_atomically(file, two.substr(0, 3)));
  errno = EINTR;  // of a call long before
  EXPECT_FALSE(is_trajectory(file));
}

/// Bits that rot must give an error, never another number.
TEST(FrameLog, RottenFramesAreNoticed) {
  const ScratchFolder folder;
  const std::string whole = *read_file(write_log(folder, 2));
  const std::size_t frames_begin = whole.size() - 2 * ((whole.size() - read_file(write_log(folder, 0))->size()) / 2);
  const auto file = folder / "rotten.part";
  for (std::size_t at = 0; at < whole.size(); at += at < frames_begin ? 1 : 97) {
    std::string rotten = whole;
    rotten[at] = static_cast<char>(rotten[at] ^ 0x04);
    ASSERT_TRUE(write_file_atomically(file, rotten));
    const auto reader = TrajectoryReader::open(file);
    if (at < frames_begin) {
      EXPECT_FALSE(reader) << at;
      continue;
    }
    ASSERT_TRUE(reader) << at << ": " << reader.error().message;
    const std::size_t damaged = at < (frames_begin + whole.size()) / 2 ? 0 : 1;
    EXPECT_EQ(reader->n_frames(), damaged == 0 ? 2U : 1U) << at << ": the last one may be half written";
    EXPECT_EQ(static_cast<bool>(reader->frame(0)), damaged != 0) << at;
    EXPECT_FALSE(FrameLog::reopen(file, 2)) << at;
  }
}

TEST(FrameLog, ContinuesATrajectoryThatIsDone) {
  const ScratchFolder folder;
  const std::string log = *read_file(write_log(folder, 3));
  write_frames(folder, 5);
  const RunDirectory directory{folder.path()};
  std::filesystem::remove(directory.frames());
  EXPECT_FALSE(reopen_frames(directory, 6)) << "more than there are";
  EXPECT_FALSE(std::filesystem::exists(directory.frames()));
  ASSERT_TRUE(reopen_frames(directory, 5));
  std::filesystem::remove(directory.frames());
  ASSERT_TRUE(reopen_frames(directory, 3));
  EXPECT_EQ(*read_file(directory.frames()), log);
  EXPECT_EQ(TrajectoryReader::open(directory.trajectory())->n_frames(), 5U) << "that stays as it is";
}

/// Bits that rot inside a frame must give an error, never another number. (Headers of HDF5 itself carry no checksum in
/// files that old readers understand; they are not part of this promise.)
TEST(Trajectory, RottenFramesAreNoticed) {
  const ScratchFolder folder;
  const auto file = write_frames(folder, 2);
  const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t dataset = H5Dopen2(h5, "/particles/trajectory/position/value", H5P_DEFAULT);
  const hsize_t first_chunk[3] = {0, 0, 0};
  unsigned filters = 0;
  haddr_t address = 0;
  hsize_t size = 0;
  ASSERT_GE(H5Dget_chunk_info_by_coord(dataset, first_chunk, &filters, &address, &size), 0);
  H5Dclose(dataset);
  H5Fclose(h5);
  for (hsize_t at = 0; at < size; at += 97) {
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    bytes.seekg(static_cast<std::streamoff>(address + at));
    const char old = static_cast<char>(bytes.get());
    bytes.seekp(static_cast<std::streamoff>(address + at));
    bytes.put(static_cast<char>(old ^ 0x04));
    bytes.close();
    const auto reader = test::good(TrajectoryReader::open(file));
    EXPECT_FALSE(reader->frame(0)) << at;
    EXPECT_TRUE(reader->frame(1));
    std::fstream back(file, std::ios::in | std::ios::out | std::ios::binary);
    back.seekp(static_cast<std::streamoff>(address + at));
    back.put(old);
  }
}

TEST(Trajectory, ErrorsNameTheFile) {
  const ScratchFolder folder;
  EXPECT_THAT(test::refusal(FrameLog::create(folder / "no" / "t.part", header())), testing::HasSubstr("no/t.part"));
  ASSERT_TRUE(write_file_atomically(folder / "t.h5", "not HDF5"));
  EXPECT_FALSE(TrajectoryReader::open(folder / "t.h5"));
  EXPECT_FALSE(FrameLog::reopen(folder / "t.h5", 0));
  EXPECT_FALSE(TrajectoryReader::open(folder / "absent.h5"));
  auto log = test::good(FrameLog::create(folder / "t.part", header()));
  Snapshot other = snapshot(0);
  other.position.pop_back();
  EXPECT_FALSE(log->append(record(other))) << "another number of rods";
}

/// The disk fills up at every possible place of a frame; the writer then closes its file, or is killed.
TEST(FrameLog, FullDiskIsReportedAndTheFileGoesOnLater) {
  const ScratchFolder folder;
  const auto whole = write_log(folder, 2);
  const auto file = folder / "filling.part";
  constexpr unsigned kFrameBytes = kRods * 13 * sizeof(float);
  constexpr int kPlaces = 12;
  for (int place = 0; place < 2 * kPlaces; ++place) {
    const bool killed = place % 2 == 0;
    std::filesystem::copy_file(whole, file, std::filesystem::copy_options::overwrite_existing);
    const auto limit = std::filesystem::file_size(whole) + kFrameBytes * static_cast<unsigned>(place / 2) / kPlaces;
    EXPECT_EQ(in_child([&] {
                auto log = FrameLog::reopen(file, 2);
                limit_file_size(limit);
                const auto done = log->append(record(snapshot(2000)));
                if (done || done.error().message.find("filling.part") == std::string::npos) return false;
                if (killed) _exit(0);
                return true;
              }),
              0)
        << place;
    auto log = FrameLog::reopen(file, 2);
    ASSERT_TRUE(log) << place << ": " << log.error().message;
    ASSERT_TRUE(log->append(record(snapshot(2000))));
    const auto reader = TrajectoryReader::open(file);
    for (std::size_t i = 0; i < 3; ++i) expect_same(*reader->frame(i), snapshot(1000 * static_cast<Tick>(i)));
  }
}

TEST(Trajectory, AFullDiskLeavesTheFormerFile) {
  const ScratchFolder folder;
  const auto file = write_frames(folder, 2);
  const std::string before = *read_file(file);
  const auto log = write_log(folder, 40);
  const auto n_files = [&] {
    return std::distance(std::filesystem::directory_iterator(folder.path()), std::filesystem::directory_iterator());
  };
  const auto files_before = n_files();
  for (const unsigned limit : {100U, 5000U, 40000U, 200000U}) {
    EXPECT_EQ(in_child([&] {
                const auto frames = TrajectoryReader::open(log);
                limit_file_size(limit);
                const auto done = write_trajectory(file, frames->recorded());
                return !done && done.error().message.find("trajectory.h5") != std::string::npos;
              }),
              0)
        << limit;
    EXPECT_EQ(*read_file(file), before) << limit;
    EXPECT_EQ(n_files(), files_before) << limit;
  }
}

/// The structure that H5MD readers (MDAnalysis, VMD) were found to need.
class H5mdStructure : public testing::Test {
 protected:
  void SetUp() override {
    file_ = H5Fopen(write_frames(folder_, 2).c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    ASSERT_GE(file_, 0);
  }
  void TearDown() override { H5Fclose(file_); }

  std::vector<hsize_t> shape(const std::string& path) const {
    const hid_t dataset = H5Dopen2(file_, path.c_str(), H5P_DEFAULT);
    if (dataset < 0) return {};
    const hid_t space = H5Dget_space(dataset);
    std::vector<hsize_t> extent(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    H5Sclose(space);
    H5Dclose(dataset);
    return extent;
  }
  haddr_t address(const std::string& path) const {
    H5O_info_t info;
    return H5Oget_info_by_name2(file_, path.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT) < 0 ? HADDR_UNDEF : info.addr;
  }
  bool has_attribute(const std::string& path, const std::string& name) const {
    return H5Aexists_by_name(file_, path.c_str(), name.c_str(), H5P_DEFAULT) > 0;
  }

  std::string text_attribute(const std::string& path, const std::string& name) const {
    return hdf5_text_attribute(file_, path, name);
  }
  std::string unit(const std::string& path) const { return text_attribute(path, "unit"); }

  ScratchFolder folder_;
  hid_t file_ = -1;
};

TEST_F(H5mdStructure, ArraysHaveTheirShapes) {
  using Shape = std::vector<hsize_t>;
  const std::string group = "/particles/trajectory/";
  EXPECT_EQ(shape(group + "position/value"), (Shape{2, kRods, 3}));
  EXPECT_EQ(shape(group + "image/value"), (Shape{2, kRods, 3}));
  EXPECT_EQ(shape(group + "velocity/value"), (Shape{2, kRods, 3}));
  EXPECT_EQ(shape(group + "orientation/value"), (Shape{2, kRods, 4}));
  EXPECT_EQ(shape(group + "box/edges/value"), (Shape{2, 3, 3})) << "edges depend on time and are a matrix";
  EXPECT_EQ(shape(group + "position/step"), (Shape{2})) << "explicit steps";
  EXPECT_EQ(shape(group + "position/time"), (Shape{2}));
}

TEST_F(H5mdStructure, StepAndTimeAreOneDataSet) {
  const std::string group = "/particles/trajectory/";
  ASSERT_NE(address(group + "position/step"), HADDR_UNDEF);
  for (const char* element : {"image", "velocity", "orientation", "box/edges"}) {
    EXPECT_EQ(address(group + element + "/step"), address(group + "position/step")) << element;
    EXPECT_EQ(address(group + element + "/time"), address(group + "position/time")) << element;
  }
}

TEST_F(H5mdStructure, ValuesAndTimesHaveTheirUnits) {
  const std::string group = "/particles/trajectory/";
  EXPECT_EQ(unit(group + "position/value"), "mm");
  EXPECT_EQ(unit(group + "velocity/value"), "mm s-1");
  EXPECT_EQ(unit(group + "box/edges/value"), "mm");
  for (const char* element : {"position", "image", "velocity", "orientation", "box/edges"}) {
    EXPECT_EQ(unit(group + element + "/time"), "s") << element;
  }
  EXPECT_EQ(unit("/parameters/bead_offset_mm"), "mm");
  EXPECT_EQ(unit("/parameters/bead_radius_mm"), "mm");
  EXPECT_FALSE(has_attribute(group + "orientation/value", "unit"));
  EXPECT_TRUE(has_attribute("/h5md/modules/units", "system"));
}

TEST_F(H5mdStructure, SaysWhichRunItIsOf) {
  EXPECT_EQ(text_attribute("/", "run_id"), "0123456789abcdef");
  EXPECT_EQ(text_attribute("/", "shaken_version"), version());
  std::uint64_t seed = 0;
  const hid_t attribute = H5Aopen(file_, "seed", H5P_DEFAULT);
  EXPECT_GE(H5Aread(attribute, H5T_NATIVE_UINT64, &seed), 0);
  H5Aclose(attribute);
  EXPECT_EQ(seed, 77U);
}

/// Files of one species in a box without walls are as they were before there were others.
TEST_F(H5mdStructure, OneKindOfRodNeedsNoSpecies) {
  EXPECT_EQ(address("/particles/trajectory/species"), HADDR_UNDEF);
  EXPECT_EQ(address("/parameters/species_2"), HADDR_UNDEF);
  EXPECT_EQ(address("/parameters/walls"), HADDR_UNDEF);
  EXPECT_EQ(address("/parameters/posts"), HADDR_UNDEF);
}

TEST_F(H5mdStructure, NamesItsFormatAndBox) {
  for (const auto& [path, version] : {std::pair("/h5md", std::vector{1, 1}), {"/h5md/modules/units", {1, 0}}}) {
    const hid_t attribute = H5Aopen_by_name(file_, path, "version", H5P_DEFAULT, H5P_DEFAULT);
    std::vector<int> numbers(H5Aget_storage_size(attribute) / sizeof(int));
    EXPECT_GE(H5Aread(attribute, H5T_NATIVE_INT, numbers.data()), 0);
    H5Aclose(attribute);
    EXPECT_EQ(numbers, version) << path;
  }
  EXPECT_TRUE(has_attribute("/h5md/author", "name"));
  EXPECT_TRUE(has_attribute("/h5md/creator", "version"));
  EXPECT_TRUE(has_attribute("/particles/trajectory/box", "dimension"));
  EXPECT_TRUE(has_attribute("/particles/trajectory/box", "boundary"));
}

}  // namespace
}  // namespace shaken::run
