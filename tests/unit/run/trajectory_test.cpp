// SPDX-License-Identifier: MIT
#include "run/files/trajectory.h"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <fstream>
#include <random>

#include "base/files.h"
#include "run/files/version.h"
#include "tests/unit/run/hdf5_attributes.h"
#include "tests/unit/run/temporary_folder.h"

namespace shaken::run {
namespace {

constexpr double kSide = 83.73;
constexpr double kGap = 1.2;
constexpr double kDt = 4e-6;
constexpr int kRods = 300;

TrajectoryHeader header() {
  TrajectoryHeader header{kRods, kSide, kGap, kDt, {-2.05, 0, 2.05}, {0.2, 0.4, 0.2}, R"({"rods": {"count": 300}})"};
  header.provenance = {"0123456789abcdef", 77};
  return header;
}

Snapshot snapshot(Tick tick) {
  std::mt19937_64 rng(static_cast<std::uint64_t>(tick) + 1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  Snapshot s;
  s.tick = tick;
  s.time = static_cast<double>(tick) * kDt;
  s.box_side = kSide;
  for (int i = 0; i < kRods; ++i) {
    s.position.emplace_back(kSide * unit(rng), kSide * unit(rng), kGap * unit(rng));
    s.director.push_back(Vec3{normal(rng), normal(rng), normal(rng)}.normalized());
    s.velocity.emplace_back(10 * normal(rng), 10 * normal(rng), 100 * normal(rng));
    s.angular_velocity.emplace_back(0, 0, 0);
    s.image.push_back({static_cast<std::int32_t>(normal(rng) * 100), static_cast<std::int32_t>(tick)});
  }
  return s;
}

void expect_same(const TrajectoryFrame& frame, const Snapshot& s) {
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

std::filesystem::path write_frames(const TemporaryFolder& folder, Tick n_frames) {
  const auto file = folder / "trajectory.h5";
  auto writer = TrajectoryWriter::create(file, header());
  EXPECT_TRUE(writer);
  for (Tick i = 0; i < n_frames; ++i) EXPECT_TRUE(writer->append(snapshot(1000 * i)));
  return file;
}

TEST(Trajectory, ComesBackAsWritten) {
  const TemporaryFolder folder;
  const auto file = write_frames(folder, 3);
  const auto reader = TrajectoryReader::open(file);
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->header().n_rods, kRods);
  EXPECT_EQ(reader->header().box_side, kSide);
  EXPECT_EQ(reader->header().gap, kGap);
  EXPECT_EQ(reader->header().dt, kDt);
  EXPECT_EQ(reader->header().bead_offset, header().bead_offset);
  EXPECT_EQ(reader->header().bead_radius, header().bead_radius);
  EXPECT_EQ(reader->header().scene_json, header().scene_json);
  EXPECT_TRUE(reader->header().added_beads.empty());
  EXPECT_TRUE(reader->header().species_of_rod.empty());
  EXPECT_FALSE(reader->header().walls);
  ASSERT_EQ(reader->n_frames(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto frame = reader->frame(i);
    ASSERT_TRUE(frame) << frame.error().message;
    expect_same(*frame, snapshot(1000 * static_cast<Tick>(i)));
  }
  EXPECT_FALSE(reader->frame(3));
}

TEST(Trajectory, KindsOfRodsAndSideWallsComeBack) {
  const TemporaryFolder folder;
  TrajectoryHeader several = header();
  several.added_beads = {{{0}, {0.45}}, {{-1.2, 0.1, 1.4}, {0.45, 0.3, 0.2}}};
  for (int i = 0; i < kRods; ++i)
    several.species_of_rod.push_back(static_cast<std::uint8_t>(i % 7 == 0 ? 1 : i % 5 == 0 ? 2 : 0));
  for (const Arena arena : {Arena::kDisc, Arena::kSquare, Arena::kAnnulus}) {
    several.walls = SideWalls{};
    several.walls->arena = arena;
    several.walls->size = 70.25;
    if (arena == Arena::kAnnulus) several.walls->inner = 12.5;
    several.walls->contact = {0.02, 0.7};
    const auto file = folder / "t.h5";
    std::filesystem::remove(file);
    {
      auto writer = TrajectoryWriter::create(file, several);
      ASSERT_TRUE(writer) << writer.error().message;
      ASSERT_TRUE(writer->append(snapshot(0)));
    }
    ASSERT_TRUE(TrajectoryWriter::reopen(file, 0)->append(snapshot(1)));
    const auto reader = TrajectoryReader::open(file);
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ(reader->header().bead_radius, several.bead_radius);
    EXPECT_EQ(reader->header().added_beads, several.added_beads);
    EXPECT_EQ(reader->header().species_of_rod, several.species_of_rod);
    EXPECT_EQ(reader->header().walls, several.walls);
    ASSERT_EQ(reader->n_frames(), 2U);
    expect_same(*reader->frame(1), snapshot(1));
  }
}

TEST(Trajectory, AKindWithoutBeadsIsRefused) {
  const TemporaryFolder folder;
  TrajectoryHeader several = header();
  several.added_beads = {{{0}, {0.45}}};
  several.species_of_rod.assign(kRods, 2);
  ASSERT_TRUE(TrajectoryWriter::create(folder / "t.h5", several));
  const auto reader = TrajectoryReader::open(folder / "t.h5");
  ASSERT_FALSE(reader);
  EXPECT_NE(reader.error().message.find("beads are not there"), std::string::npos) << reader.error().message;
  several.species_of_rod.assign(kRods - 1, 1);
  std::filesystem::remove(folder / "t.h5");
  ASSERT_TRUE(TrajectoryWriter::create(folder / "t.h5", several));
  EXPECT_FALSE(TrajectoryReader::open(folder / "t.h5")) << "a kind for each rod";
}

TEST(Trajectory, PositionsStayInTheBoxWhenRounded) {
  const TemporaryFolder folder;
  Snapshot s = snapshot(0);
  s.position[0] = Vec3(std::nextafter(kSide, 0.0), kSide - 1e-7, 0.6);
  auto writer = TrajectoryWriter::create(folder / "t.h5", header());
  ASSERT_TRUE(writer->append(s));
  const auto reader = TrajectoryReader::open(folder / "t.h5");
  const auto frame = reader->frame(0);
  EXPECT_LT(frame->position[0].x(), kSide);
  EXPECT_LT(frame->position[0].y(), kSide);
  EXPECT_NEAR(frame->position[0].x(), kSide, 1e-5);
}

TEST(Trajectory, DirectorsKeepTheirSignAlsoNearThePoles) {
  const TemporaryFolder folder;
  Snapshot s = snapshot(0);
  const std::vector<Vec3> special{{0, 0, 1},  {0, 0, -1},    {1, 0, 0},     {-1, 0, 0},    {0, 1, 0},
                                  {0, -1, 0}, {1e-5, 0, -1}, {0, -1e-4, 1}, {-1e-9, 0, -1}};
  for (std::size_t i = 0; i < special.size(); ++i) s.director[i] = special[i].normalized();
  auto writer = TrajectoryWriter::create(folder / "t.h5", header());
  ASSERT_TRUE(writer->append(s));
  expect_same(*TrajectoryReader::open(folder / "t.h5")->frame(0), s);
}

TEST(Trajectory, CanBeReadWhileItGrows) {
  const TemporaryFolder folder;
  auto writer = TrajectoryWriter::create(folder / "t.h5", header());
  for (Tick i = 0; i < 4; ++i) {
    const auto reader = TrajectoryReader::open(folder / "t.h5");
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ(reader->n_frames(), static_cast<std::size_t>(i));
    ASSERT_TRUE(writer->append(snapshot(i)));
  }
}

TEST(Trajectory, SurvivesTheWritersSuddenEnd) {
  const TemporaryFolder folder;
  EXPECT_EQ(in_child([&] {
              auto writer = TrajectoryWriter::create(folder / "t.h5", header());
              for (Tick i = 0; i < 5; ++i) {
                if (!writer->append(snapshot(i))) return false;
              }
              kill(getpid(), SIGKILL);
              return true;
            }),
            128);
  const auto reader = TrajectoryReader::open(folder / "t.h5");
  ASSERT_TRUE(reader) << reader.error().message;
  ASSERT_EQ(reader->n_frames(), 5U);
  expect_same(*reader->frame(4), snapshot(4));
}

TEST(Trajectory, ReopeningCutsWhatCameAfterTheCheckpoint) {
  const TemporaryFolder folder;
  const auto file = write_frames(folder, 5);
  {
    auto writer = TrajectoryWriter::reopen(file, 2500);
    ASSERT_TRUE(writer) << writer.error().message;
    EXPECT_EQ(writer->n_frames(), 3U);
    ASSERT_TRUE(writer->append(snapshot(2700)));
    EXPECT_EQ(writer->n_frames(), 4U);
  }
  const auto reader = TrajectoryReader::open(file);
  ASSERT_EQ(reader->n_frames(), 4U);
  expect_same(*reader->frame(2), snapshot(2000));
  expect_same(*reader->frame(3), snapshot(2700));
}

/// What a writer that was killed between two data sets leaves.
TEST(Trajectory, TornLastFrameIsLeftOutAndCut) {
  const TemporaryFolder folder;
  const auto file = write_frames(folder, 3);
  const hid_t h5 = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(h5, 0);
  for (const char* name : {"position", "image", "velocity", "orientation"}) {
    const std::string path = std::string("/particles/trajectory/") + name + "/value";
    const hid_t dataset = H5Dopen2(h5, path.c_str(), H5P_DEFAULT);
    const hsize_t extent[3] = {4, kRods, name == std::string("orientation") ? 4U : 3U};
    ASSERT_GE(H5Dset_extent(dataset, extent), 0);
    H5Dclose(dataset);
  }
  H5Fclose(h5);
  EXPECT_EQ(TrajectoryReader::open(file)->n_frames(), 3U) << "one more row in some of the data sets";

  const hid_t again = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  for (const char* name : {"position/step", "position/time"}) {
    const hid_t dataset = H5Dopen2(again, (std::string("/particles/trajectory/") + name).c_str(), H5P_DEFAULT);
    const hsize_t extent[1] = {4};
    ASSERT_GE(H5Dset_extent(dataset, extent), 0);
    H5Dclose(dataset);
  }
  const hid_t edges = H5Dopen2(again, "/particles/trajectory/box/edges/value", H5P_DEFAULT);
  const hsize_t extent[3] = {4, 3, 3};
  ASSERT_GE(H5Dset_extent(edges, extent), 0);
  H5Dclose(edges);
  H5Fclose(again);
  EXPECT_EQ(TrajectoryReader::open(file)->n_frames(), 3U) << "a row everywhere, but no content";

  auto writer = TrajectoryWriter::reopen(file, 1000000);
  ASSERT_TRUE(writer) << writer.error().message;
  EXPECT_EQ(writer->n_frames(), 3U);
  ASSERT_TRUE(writer->append(snapshot(3000)));
  expect_same(*TrajectoryReader::open(file)->frame(3), snapshot(3000));
}

/// Bits that rot inside a frame must give an error, never another number. (Headers of HDF5 itself carry no checksum in
/// files that old readers understand; they are not part of this promise.)
TEST(Trajectory, RottenFramesAreNoticed) {
  const TemporaryFolder folder;
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
    const auto reader = TrajectoryReader::open(file);
    ASSERT_TRUE(reader);
    EXPECT_FALSE(reader->frame(0)) << at;
    EXPECT_TRUE(reader->frame(1));
    std::fstream back(file, std::ios::in | std::ios::out | std::ios::binary);
    back.seekp(static_cast<std::streamoff>(address + at));
    back.put(old);
  }
}

TEST(Trajectory, ErrorsNameTheFile) {
  const TemporaryFolder folder;
  const auto nowhere = TrajectoryWriter::create(folder / "no" / "t.h5", header());
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().message.find("no/t.h5"), std::string::npos) << nowhere.error().message;
  ASSERT_TRUE(write_file_atomically(folder / "t.h5", "not HDF5"));
  EXPECT_FALSE(TrajectoryReader::open(folder / "t.h5"));
  EXPECT_FALSE(TrajectoryWriter::reopen(folder / "t.h5", 0));
  EXPECT_FALSE(TrajectoryReader::open(folder / "absent.h5"));
  auto writer = TrajectoryWriter::create(folder / "t.h5", header());
  ASSERT_TRUE(writer);
  Snapshot other = snapshot(0);
  other.position.pop_back();
  EXPECT_FALSE(writer->append(other)) << "another number of rods";
}

/// The disk fills up at every possible place of a frame; the writer then closes its file, or is killed.
TEST(Trajectory, FullDiskIsReportedAndTheFileGoesOnLater) {
  const TemporaryFolder folder;
  const auto whole = write_frames(folder, 2);
  const auto file = folder / "filling.h5";
  std::filesystem::copy_file(whole, file);
  constexpr unsigned kFrameBytes = kRods * 13 * sizeof(float);
  constexpr int kPlaces = 12;
  for (int place = 0; place < 2 * kPlaces; ++place) {
    const bool killed = place % 2 == 0;
    std::filesystem::copy_file(whole, file, std::filesystem::copy_options::overwrite_existing);
    const auto limit = std::filesystem::file_size(whole) + kFrameBytes * static_cast<unsigned>(place / 2) / kPlaces;
    EXPECT_EQ(in_child([&] {
                auto writer = TrajectoryWriter::reopen(file, 1000);
                limit_file_size(limit);
                const auto done = writer->append(snapshot(2000));
                if (done || done.error().message.find("filling.h5") == std::string::npos) return false;
                if (killed) _exit(0);
                return true;
              }),
              0)
        << place;
    auto writer = TrajectoryWriter::reopen(file, 1000);
    ASSERT_TRUE(writer) << place << ": " << writer.error().message;
    EXPECT_EQ(writer->n_frames(), 2U) << place;
    ASSERT_TRUE(writer->append(snapshot(2000)));
    const auto reader = TrajectoryReader::open(file);
    for (std::size_t i = 0; i < 3; ++i) expect_same(*reader->frame(i), snapshot(1000 * static_cast<Tick>(i)));
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

  TemporaryFolder folder_;
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
  EXPECT_TRUE(has_attribute("/h5md/modules/units", "version"));
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
}

TEST_F(H5mdStructure, NamesItsFormatAndBox) {
  EXPECT_TRUE(has_attribute("/h5md", "version"));
  EXPECT_TRUE(has_attribute("/h5md/author", "name"));
  EXPECT_TRUE(has_attribute("/h5md/creator", "version"));
  EXPECT_TRUE(has_attribute("/particles/trajectory/box", "dimension"));
  EXPECT_TRUE(has_attribute("/particles/trajectory/box", "boundary"));
}

}  // namespace
}  // namespace shaken::run
