// The compiled half of the package `shaken`: `shaken._native`, for python/shaken/simulation.py and measuring.py alone.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/core/types.h"
#include "python/native/measured_arrays.h"
#include "python/native/simulated_run.h"
#include "run/files/recorded_frames.h"
#include "run/files/trajectory.h"
#include "run/recorded/tracks.h"
#include "scene/canonical.h"
#include "sim/cell.h"

namespace shaken::python {
namespace {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

using Integers = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;

/// (n, 3)
Doubles array_of(const std::vector<Vec3>& vectors) {
  Doubles array({static_cast<py::ssize_t>(vectors.size()), py::ssize_t{3}});
  auto values = array.mutable_unchecked<2>();
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) values(static_cast<py::ssize_t>(i), k) = vectors[i][k];
  }
  return array;
}

/// The rows of an array (n, 3); fails with what it is called where it has another shape.
std::vector<Vec3> vectors_of(const Doubles& array, const std::string& name) {
  if (array.ndim() != 2 || array.shape(1) != 3) throw py::value_error(name + " must have the shape (n, 3)");
  std::vector<Vec3> vectors(static_cast<std::size_t>(array.shape(0)));
  const auto values = array.unchecked<2>();
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const auto row = static_cast<py::ssize_t>(i);
    vectors[i] = {values(row, 0), values(row, 1), values(row, 2)};
  }
  return vectors;
}

/// What Python shows as a ShakenError.
class Refused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

template <class T>
T value_or_raise(Result<T> result) {
  if (!result) throw Refused(result.error().message);
  return std::move(result).value();
}

std::span<const std::byte> bytes_of_python(const py::bytes& bytes) {
  const auto view = static_cast<std::string_view>(bytes);
  return std::as_bytes(std::span(view));
}
py::bytes python_bytes(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Asks for Ctrl-C in the middle of long work without Python.
bool goes_on() {
  const py::gil_scoped_acquire held;
  return PyErr_CheckSignals() == 0;
}
/// The result of work that asks whether to end: that it was ended, rather than what it says of it.
template <class T>
T value_unless_interrupted(Result<T> result) {
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  return value_or_raise(std::move(result));
}

/// Other threads of Python go on meanwhile.
template <class Work>
auto without_python(const Work& work) {
  const py::gil_scoped_release released;
  return work();
}

py::dict dict_of(const run::Observables& arrays) {
  py::dict found;
  for (const auto& [name, values] : arrays)
    found[py::str(name)] = Doubles(static_cast<py::ssize_t>(values.size()), values.data());
  return found;
}

/// A run, one thread at a time. While it steps other threads of Python go on.
class NativeSimulation {
  template <class Work>
  auto with_run(const Work& work) {
    return without_python([&] {  // before the locks: who holds them may ask for Python
      std::unique_lock turn(turn_);
      const std::scoped_lock lock(mutex_);
      turn.unlock();
      return work(run_);
    });
  }

 public:
  NativeSimulation(const std::string& scene, std::vector<std::string> settings)
      : run_(value_unless_interrupted(without_python([&] {
          return SimulatedRun::start({scene, std::move(settings)}, goes_on);
        }))) {}
  NativeSimulation(const std::string& scene, std::vector<std::string> settings, const Doubles& positions,
                   const Doubles& directors, const std::optional<Doubles>& velocities,
                   const std::optional<Doubles>& angular_velocities, const std::vector<int>& species)
      : NativeSimulation({scene, std::move(settings)},
                         rods_of(positions, directors, velocities, angular_velocities, species),
                         !velocities && !angular_velocities) {}
  explicit NativeSimulation(const py::tuple& saved) : run_(value_or_raise(SimulatedRun::resume(saved_of(saved)))) {}

  void use_threads(int n) {
    with_run([n](SimulatedRun& run) { run.simulation().use_threads(n); });
  }

  void advance_to(Tick target) {
    for (bool is_there = false; !is_there;) {
      std::optional<NumericalTrouble> trouble;
      with_run([&](SimulatedRun& run) {
        if (!run.trouble()) is_there = run.advance(target);
        trouble = run.trouble();
      });
      if (trouble) throw Trouble{*trouble};
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  }

  /// With the next vibration, to which it steps.
  void begin_stage(const std::vector<std::string>& settings) {
    const Result<void> allowed = with_run([&](const SimulatedRun& run) { return run.may_set(settings); });
    if (!allowed) throw Refused(allowed.error().message);  // before it steps
    advance_to(with_run([](const SimulatedRun& run) { return run.next_beat(); }));
    const Result<void> done = with_run([&](SimulatedRun& run) { return run.begin_stage(settings, goes_on); });
    if (PyErr_Occurred() != nullptr) throw py::error_already_set();
    if (!done) throw Refused(done.error().message);
  }

  Tick tick() {
    return with_run([](const SimulatedRun& run) { return run.simulation().tick(); });
  }
  double time() {
    return with_run([](const SimulatedRun& run) { return run.simulation().time(); });
  }
  double time_before() {
    return with_run([](const SimulatedRun& run) { return run.time_before(); });
  }
  double step() {
    return with_run([](const SimulatedRun& run) { return run.plan().system.dt; });
  }
  std::uint64_t state_hash() {
    return with_run([](const SimulatedRun& run) { return run.simulation().state_hash(); });
  }
  std::string scene() {
    return with_run([](const SimulatedRun& run) { return scene::to_json(run.plan()).dump(); });
  }

  py::dict frame() {
    const auto [now, gap] =
        with_run([](const SimulatedRun& run) { return std::pair(run.simulation().snapshot(), run.plan().system.gap); });
    Integers images({static_cast<py::ssize_t>(now.n_rods()), py::ssize_t{3}});
    auto values = images.mutable_unchecked<2>();
    for (std::size_t i = 0; i < now.n_rods(); ++i) {
      const auto row = static_cast<py::ssize_t>(i);
      values(row, 0) = now.image[i][0];
      values(row, 1) = now.image[i][1];
      values(row, 2) = 0;
    }
    py::dict found;
    found["tick"] = now.tick;
    found["time"] = now.time;
    found["positions"] = array_of(now.position);
    found["directors"] = array_of(now.director);
    found["velocities"] = array_of(now.velocity);
    found["angular_velocities"] = array_of(now.angular_velocity);
    found["images"] = images;
    found["box"] = std::vector<double>{now.box.x(), now.box.y(), gap};
    return found;
  }

  /// What stays the same from frame to frame.
  py::dict rods() {
    const Cell cell = with_run([](const SimulatedRun& run) { return run.simulation().world().cell(); });
    std::vector<int> spheres;
    for (std::size_t k = 0; k < cell.n_species(); ++k) {
      if (!cell.mean_of_species(k).has_axis()) spheres.push_back(static_cast<int>(k));
    }
    py::dict found;
    found["species"] = cell.species_of_rods();
    found["spheres"] = spheres;
    found["periodic"] = py::make_tuple(cell.period().x() > 0, cell.period().y() > 0);
    return found;
  }

  /// A trajectory.h5 with the rods as they are.
  void write_frame(const std::string& file) {
    const Result<void> done = with_run([&](const SimulatedRun& run) {
      return run::write_trajectory(
          file, run::FramesInMemory(run::trajectory_header(run.simulation().world(), scene::to_json(run.plan()).dump(),
                                                           run::provenance_of(run.plan())),
                                    {run::record(run.simulation().snapshot())}));
    });
    if (!done) throw Refused(done.error().message);
  }

  py::tuple results() {
    const auto [summary, reduction] = with_run([](const SimulatedRun& run) {
      run::Reduction found = run.reduce();
      return std::pair(run.summary(found), std::move(found));
    });
    return py::make_tuple(summary, dict_of(reduction.arrays));
  }

  py::tuple save() {
    const SavedRun saved = value_or_raise(with_run([](const SimulatedRun& run) { return run.save(); }));
    return py::make_tuple(saved.scene.text, saved.scene.settings, saved.start ? saved.start->run : "",
                          saved.start ? saved.start->time : 0.0, saved.time_before, saved.spent.cpu_seconds,
                          saved.spent.wall_seconds, saved.spent.started, python_bytes(saved.simulation),
                          python_bytes(saved.measurements));
  }

  struct Trouble {
    NumericalTrouble what;
  };

 private:
  NativeSimulation(Scene scene, const std::vector<run::ImportedRod>& rods, bool draws_velocities)
      : run_(value_or_raise(
            without_python([&] { return SimulatedRun::start(std::move(scene), rods, draws_velocities); }))) {}

  static SavedRun saved_of(const py::tuple& saved) {
    SavedRun found;
    found.scene = {saved[0].cast<std::string>(), saved[1].cast<std::vector<std::string>>()};
    const auto run = saved[2].cast<std::string>();
    if (!run.empty()) found.start = scene::StartState{run, saved[3].cast<double>()};
    found.time_before = saved[4].cast<double>();
    const auto assign = [](std::vector<std::byte>& to, const py::bytes& from) {
      const auto bytes = bytes_of_python(from);
      to.assign(bytes.begin(), bytes.end());
    };
    found.spent = {saved[5].cast<double>(), saved[6].cast<double>(), saved[7].cast<std::string>()};
    assign(found.simulation, saved[8].cast<py::bytes>());
    assign(found.measurements, saved[9].cast<py::bytes>());
    return found;
  }

  static std::vector<run::ImportedRod> rods_of(const Doubles& positions, const Doubles& directors,
                                               const std::optional<Doubles>& velocities,
                                               const std::optional<Doubles>& angular_velocities,
                                               const std::vector<int>& species) {
    const std::vector<Vec3> at = vectors_of(positions, "positions"), along = vectors_of(directors, "directors");
    const std::vector<Vec3> still(at.size(), Vec3::Zero());
    const std::vector<Vec3> v = velocities ? vectors_of(*velocities, "velocities") : still;
    const std::vector<Vec3> w = angular_velocities ? vectors_of(*angular_velocities, "angular_velocities") : still;
    if (along.size() != at.size() || v.size() != at.size() || w.size() != at.size() ||
        (!species.empty() && species.size() != at.size())) {
      throw py::value_error("positions, directors, velocities and species must be of the same number of rods");
    }
    std::vector<run::ImportedRod> rods;
    for (std::size_t i = 0; i < at.size(); ++i) {
      const double length = along[i].norm();
      if (!(length > 0) || !along[i].allFinite() || !at[i].head<2>().allFinite() || !v[i].allFinite() ||
          !w[i].allFinite())
        throw Refused(fmt::format("rod {}: a number is none, or its director has no length", i));
      if (!species.empty() && (species[i] < 0 || species[i] > std::numeric_limits<std::uint8_t>::max()))
        throw Refused(fmt::format("rod {} is of species {}, which there is not", i, species[i]));
      rods.push_back({static_cast<int>(i), static_cast<std::uint8_t>(species.empty() ? 0 : species[i]), at[i],
                      along[i] / length, v[i], w[i]});
    }
    return rods;
  }

  SimulatedRun run_;
  std::mutex mutex_;
  std::mutex turn_;  ///< held by who waits for the other, so that a thread that steps lets others look in between
};

/// What the arrays of all frames tell.
struct KnownOfFrames {
  bool has_velocities = false, has_tilts = false, is_followed = false;
  std::optional<std::string> lacking_words{};  ///< of frames of a run; none where nobody knows whether heads are told
  run::Lacking lacking(std::span<const Snapshot> frames) const {
    run::Lacking found{run::Needs::kImpacts, run::Needs::kSpins};
    if (!has_velocities) found.insert(run::Needs::kVelocities);
    if (!has_tilts) found.insert(run::Needs::kTilts);
    if (!is_followed) found.insert(run::Needs::kIdentities);
    if (lacking_words) {
      found.merge(run::lacking_of(*lacking_words));
    } else {
      run::HeadsSeen heads;
      for (const Snapshot& frame : frames) std::ranges::for_each(frame.director, [&](const Vec3& n) { heads.see(n); });
      if (!heads.are_told()) found.insert(run::Needs::kHeads);
    }
    return found;
  }
};

/// `frames`: (positions, directors, velocities, images or None) of each, (n, 3), and the sides of its box, or None.
py::tuple measure(const std::string& scene, std::vector<std::string> settings, const py::list& frames, double interval,
                  bool has_velocities, bool has_tilts, bool is_followed, std::optional<std::string> lacking_words) {
  const bool is_tracked = lacking_words && !lacking_words->empty();
  const KnownOfFrames known{has_velocities, has_tilts, is_followed, std::move(lacking_words)};
  std::vector<Snapshot> snapshots;
  for (const py::handle each : frames) {
    const auto [positions, directors, velocities, images, box] = each.cast<
        std::tuple<Doubles, Doubles, Doubles, std::optional<Integers>, std::optional<std::pair<double, double>>>>();
    Snapshot frame;
    if (box) frame.box = Box(box->first, box->second);
    frame.position = vectors_of(positions, "positions");
    frame.director = vectors_of(directors, "directors");
    frame.velocity = vectors_of(velocities, "velocities");
    if (images) {
      const auto crossings = images->unchecked<2>();
      for (py::ssize_t i = 0; i < images->shape(0); ++i) frame.image.push_back({crossings(i, 0), crossings(i, 1)});
    }
    snapshots.push_back(std::move(frame));
  }
  Result<Measured> found = without_python([&] {
    run::Lacking lacking = known.lacking(snapshots);
    return measure_arrays({scene, std::move(settings)}, std::move(snapshots), interval, std::move(lacking), is_tracked,
                          goes_on);
  });
  const Measured measured = value_unless_interrupted(std::move(found));
  return py::make_tuple(measured.scene, measured.summary, dict_of(measured.arrays));
}

}  // namespace

PYBIND11_MODULE(_native, module) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Refused& refused) {
      PyErr_SetString(py::module_::import("shaken.errors").attr("ShakenError").ptr(), refused.what());
    } catch (const NativeSimulation::Trouble& trouble) {
      const py::object type = py::module_::import("shaken.errors").attr("NumericalTrouble");
      const py::object value = type(trouble.what.what, trouble.what.tick, trouble.what.rods);
      PyErr_SetObject(type.ptr(), value.ptr());
    }
  });
  using Strings = std::vector<std::string>;
  py::class_<NativeSimulation>(module, "Simulation")
      .def(py::init<const std::string&, Strings>())
      .def(py::init<const std::string&, Strings, const Doubles&, const Doubles&, const std::optional<Doubles>&,
                    const std::optional<Doubles>&, const std::vector<int>&>())
      .def(py::init<const py::tuple&>())
      .def("use_threads", &NativeSimulation::use_threads)
      .def("advance_to", &NativeSimulation::advance_to)
      .def("begin_stage", &NativeSimulation::begin_stage)
      .def("tick", &NativeSimulation::tick)
      .def("time", &NativeSimulation::time)
      .def("time_before", &NativeSimulation::time_before)
      .def("step", &NativeSimulation::step)
      .def("state_hash", &NativeSimulation::state_hash)
      .def("scene", &NativeSimulation::scene)
      .def("frame", &NativeSimulation::frame)
      .def("rods", &NativeSimulation::rods)
      .def("write_frame", &NativeSimulation::write_frame)
      .def("results", &NativeSimulation::results)
      .def("save", &NativeSimulation::save);
  module.def("measure", &measure);
}

}  // namespace shaken::python
