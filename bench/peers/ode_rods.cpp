// The peers' scene in ODE: rods are bodies with a sphere for each bead, plates are kinematic boxes, QuickStep solves.
// Built and run by ode.py; no part of Shaken.
//   ode_rods squeeze IN OUT dt squeeze rest              moves the side walls in; writes the state
//   ode_rods run     IN FRAMES dt warm_up timed n every   prints the CPU seconds of `timed`; writes n frames
// Files are in mm, s, mg. ODE computes in mm, 10 ms and rod masses, where everything is of the order of one.
#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

namespace {

using Vec = std::array<double, 3>;

constexpr double kTime = 0.01;  // ODE's unit of time [s]
constexpr double kWall = 4.0;   // thickness of walls and plates [mm]
// Of QuickStep. Overlaps below `slop` are left alone, deeper ones corrected, but not faster than `kMaxCorrection`, or
// else correction would shake the rods.
constexpr int kIterations = 20;
constexpr double kErrorReduction = 0.2;
constexpr double kSlop = 0.001;         // [mm]
constexpr double kMaxCorrection = 0.2;  // [mm / 10 ms]

enum Kind : std::intptr_t { kBead = 1, kPlate = 2, kSide = 3 };

struct Rod {
  Vec position, director, velocity, angular_velocity;
};

struct State {
  int n_rods, n_beads;
  double side, gap, amplitude, frequency, gravity, mass, inertia_par, inertia_perp, mu_rod, mu_plate, restitution, time;
  std::vector<double> offset, radius;
  std::vector<Rod> rods;

  double half() const { return offset.back(); }
  double thickest() const { return *std::max_element(radius.begin(), radius.end()); }
};

State read_state(const char* file) {
  std::ifstream in(file);
  State s{};
  in >> s.n_rods >> s.n_beads >> s.side >> s.gap >> s.amplitude >> s.frequency >> s.gravity >> s.mass >>
      s.inertia_par >> s.inertia_perp >> s.mu_rod >> s.mu_plate >> s.restitution >> s.time;
  s.offset.resize(static_cast<std::size_t>(s.n_beads));
  s.radius.resize(static_cast<std::size_t>(s.n_beads));
  for (int b = 0; b < s.n_beads; ++b) in >> s.offset[b] >> s.radius[b];
  s.rods.resize(static_cast<std::size_t>(s.n_rods));
  for (Rod& rod : s.rods) {
    for (Vec* v : {&rod.position, &rod.director, &rod.velocity, &rod.angular_velocity}) {
      for (double& c : *v) in >> c;
    }
  }
  if (!in) {
    std::cerr << file << ": not a state\n";
    std::exit(2);
  }
  return s;
}

void write_state(const State& s, const char* file) {
  std::ofstream out(file);
  out << std::setprecision(17) << s.n_rods << ' ' << s.n_beads << ' ' << s.side << ' ' << s.gap << ' ' << s.amplitude
      << ' ' << s.frequency << ' ' << s.gravity << ' ' << s.mass << ' ' << s.inertia_par << ' ' << s.inertia_perp << ' '
      << s.mu_rod << ' ' << s.mu_plate << ' ' << s.restitution << ' ' << s.time << '\n';
  for (int b = 0; b < s.n_beads; ++b) out << s.offset[b] << ' ' << s.radius[b] << '\n';
  for (const Rod& rod : s.rods) {
    for (const Vec* v : {&rod.position, &rod.director, &rod.velocity, &rod.angular_velocity}) {
      for (const double c : *v) out << c << ' ';
    }
    out << '\n';
  }
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Squared distance of the segments p + s n, q + t m, |s|, |t| <= h.
double segment_distance2(const dReal* p, const Vec& n, const dReal* q, const Vec& m, double h) {
  const Vec d{q[0] - p[0], q[1] - p[1], q[2] - p[2]};
  const auto dot = [](const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const double c = dot(n, m), dn = dot(d, n), dm = dot(d, m);
  const double denominator = 1 - c * c;
  double s = denominator > 1e-12 ? std::clamp((dn - c * dm) / denominator, -h, h) : 0.0;
  const double t = std::clamp(c * s - dm, -h, h);
  s = std::clamp(c * t + dn, -h, h);
  double d2 = 0;
  for (int k = 0; k < 3; ++k) d2 += std::pow(d[k] + t * m[k] - s * n[k], 2);
  return d2;
}

class Box {
 public:
  explicit Box(State state) : state_(std::move(state)) {
    world_ = dWorldCreate();
    space_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
    contacts_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, 0, 0, -state_.gravity * kTime * kTime);
    dWorldSetQuickStepNumIterations(world_, kIterations);
    dWorldSetERP(world_, kErrorReduction);
    dWorldSetCFM(world_, 0);
    dWorldSetContactSurfaceLayer(world_, kSlop);
    dWorldSetContactMaxCorrectingVel(world_, kMaxCorrection);
    for (const Rod& rod : state_.rods) add_rod(rod);
    const double reach = 3 * state_.side;
    for (dBodyID& plate : plates_) {
      plate = dBodyCreate(world_);
      dBodySetKinematic(plate);
      add_wall(dCreateBox(space_, reach, reach, kWall), kPlate, plate);
    }
    for (int k = 0; k < 4; ++k) {
      sides_[k] = dBodyCreate(world_);
      dBodySetKinematic(sides_[k]);
      add_wall(dCreateBox(space_, k < 2 ? kWall : reach, k < 2 ? reach : kWall, 8 * state_.gap), kSide, sides_[k]);
    }
    set_walls(0, 0);
  }

  // The side walls are this far outside of the periodic box, and move in at `speed` [mm/s].
  void set_walls(double outside, double speed) {
    outside_ = outside;
    speed_ = speed;
  }
  double outside() const { return outside_; }

  void step(double dt) {
    place_walls(dt);
    dSpaceCollide(space_, this, &Box::collide);
    dWorldQuickStep(world_, dt / kTime);
    dJointGroupEmpty(contacts_);
    state_.time += dt;
    outside_ -= speed_ * dt;
  }

  double base() const { return base_at(state_.time); }

  const State& state() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Rod& rod = state_.rods[i];
      const dReal* p = dBodyGetPosition(bodies_[i]);
      const dReal* v = dBodyGetLinearVel(bodies_[i]);
      const dReal* w = dBodyGetAngularVel(bodies_[i]);
      rod.director = director(bodies_[i]);
      for (int c = 0; c < 3; ++c) {
        rod.position[c] = p[c];
        rod.velocity[c] = v[c] / kTime;
        rod.angular_velocity[c] = w[c] / kTime;
      }
    }
    return state_;
  }

 private:
  double base_at(double time) const { return state_.amplitude * (1 + std::cos(2 * M_PI * state_.frequency * time)); }

  static Vec director(dBodyID body) {
    const dReal* R = dBodyGetRotation(body);  // its first column: beads lie along the body's x axis
    return {R[0], R[4], R[8]};
  }

  void add_rod(const Rod& rod) {
    dBodyID body = dBodyCreate(world_);
    dMass mass;
    dMassSetParameters(&mass, 1, 0, 0, 0, state_.inertia_par / state_.mass, state_.inertia_perp / state_.mass,
                       state_.inertia_perp / state_.mass, 0, 0, 0);
    dBodySetMass(body, &mass);
    dSpaceID beads = dSimpleSpaceCreate(space_);
    for (int b = 0; b < state_.n_beads; ++b) {
      dGeomID sphere = dCreateSphere(beads, state_.radius[b]);
      dGeomSetBody(sphere, body);
      dGeomSetOffsetPosition(sphere, state_.offset[b], 0, 0);
      dGeomSetData(sphere, reinterpret_cast<void*>(kBead));
    }
    dGeomSetData(reinterpret_cast<dGeomID>(beads), body);
    dMatrix3 R;
    const Vec& n = rod.director;
    const Vec other = std::abs(n[2]) < 0.9 ? Vec{0, 0, 1} : Vec{0, 1, 0};
    const double along = n[0] * other[0] + n[1] * other[1] + n[2] * other[2];
    dRFrom2Axes(R, n[0], n[1], n[2], other[0] - along * n[0], other[1] - along * n[1], other[2] - along * n[2]);
    dBodySetRotation(body, R);
    dBodySetPosition(body, rod.position[0], rod.position[1], rod.position[2]);
    dBodySetLinearVel(body, rod.velocity[0] * kTime, rod.velocity[1] * kTime, rod.velocity[2] * kTime);
    dBodySetAngularVel(body, rod.angular_velocity[0] * kTime, rod.angular_velocity[1] * kTime,
                       rod.angular_velocity[2] * kTime);
    bodies_.push_back(body);
  }

  static void add_wall(dGeomID box, Kind kind, dBodyID body) {
    dGeomSetBody(box, body);
    dGeomSetData(box, reinterpret_cast<void*>(kind));
  }

  // Walls where they are now, moving so that they are where they should be after the step.
  void place_walls(double dt) {
    const double now = base(), next = base_at(state_.time + dt);
    const double middle = state_.side / 2;
    for (int k = 0; k < 2; ++k) {
      dBodySetPosition(plates_[k], middle, middle, now + (k == 0 ? -kWall / 2 : state_.gap + kWall / 2));
      dBodySetLinearVel(plates_[k], 0, 0, (next - now) / dt * kTime);
    }
    for (int k = 0; k < 4; ++k) {
      const double out = k % 2 == 0 ? -1 : 1;
      const double place = middle + out * (middle + outside_ + kWall / 2);
      const double velocity = -out * speed_ * kTime;
      dBodySetPosition(sides_[k], k < 2 ? place : middle, k < 2 ? middle : place, 0);
      dBodySetLinearVel(sides_[k], k < 2 ? velocity : 0, k < 2 ? 0 : velocity, 0);
    }
  }

  static void collide(void* data, dGeomID a, dGeomID b) {
    Box& box = *static_cast<Box*>(data);
    if (dGeomIsSpace(a) && dGeomIsSpace(b)) {
      // rods whose axes are further apart than their thickness have no beads that touch
      auto* i = static_cast<dBodyID>(dGeomGetData(a));
      auto* j = static_cast<dBodyID>(dGeomGetData(b));
      const double reach = 2 * box.state_.thickest();
      if (segment_distance2(dBodyGetPosition(i), director(i), dBodyGetPosition(j), director(j), box.state_.half()) >
          reach * reach) {
        return;
      }
    }
    if (dGeomIsSpace(a) || dGeomIsSpace(b)) {
      dSpaceCollide2(a, b, data, &Box::collide);
      return;
    }
    dContact contact{};
    if (dCollide(a, b, 1, &contact.geom, sizeof(dContact)) == 0) return;
    const auto kind =
        std::max(reinterpret_cast<std::intptr_t>(dGeomGetData(a)), reinterpret_cast<std::intptr_t>(dGeomGetData(b)));
    contact.surface.mode = dContactBounce | dContactApprox1;
    contact.surface.mu = kind == kBead ? box.state_.mu_rod : kind == kPlate ? box.state_.mu_plate : 0.0;
    contact.surface.bounce = box.state_.restitution;
    contact.surface.bounce_vel = 0;
    dJointAttach(dJointCreateContact(box.world_, box.contacts_, &contact), dGeomGetBody(a), dGeomGetBody(b));
  }

  State state_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::vector<dBodyID> bodies_;
  std::array<dBodyID, 2> plates_{};  // base, lid
  std::array<dBodyID, 4> sides_{};   // low x, high x, low y, high y
  double outside_ = 0, speed_ = 0;
};

// How far rods reach out of the periodic box.
double overhang(const State& state) {
  double most = 0;
  for (const Rod& rod : state.rods) {
    for (int c = 0; c < 2; ++c) {
      const double reach = state.half() * std::abs(rod.director[c]) + state.thickest();
      most = std::max({most, reach - rod.position[c], rod.position[c] + reach - state.side});
    }
  }
  return most;
}

int squeeze(char** arguments) {
  const double dt = std::atof(arguments[2]), time = std::atof(arguments[3]), rest = std::atof(arguments[4]);
  const State start = read_state(arguments[0]);
  Box box(start);
  const double outside = overhang(start);
  box.set_walls(outside, outside / time);
  for (long k = std::lround(time / dt); k > 0; --k) box.step(dt);
  box.set_walls(0, 0);
  for (long k = std::lround(rest / dt); k > 0; --k) box.step(dt);
  write_state(box.state(), arguments[1]);
  return 0;
}

int run(char** arguments) {
  const double dt = std::atof(arguments[2]), warm_up = std::atof(arguments[3]), timed = std::atof(arguments[4]);
  const int n_frames = std::atoi(arguments[5]);
  const long every = std::max(1L, std::lround(std::atof(arguments[6]) / dt));
  Box box(read_state(arguments[0]));
  for (long k = std::lround(warm_up / dt); k > 0; --k) box.step(dt);
  std::ofstream out(arguments[1]);
  out << std::setprecision(9);
  for (int frame = 0; frame < n_frames; ++frame) {
    for (long k = 0; k < every; ++k) box.step(dt);
    const State& now = box.state();
    out << now.time << ' ' << box.base() << '\n';
    for (const Rod& rod : now.rods) {
      for (const Vec* v : {&rod.position, &rod.director, &rod.velocity})
        out << (*v)[0] << ' ' << (*v)[1] << ' ' << (*v)[2] << ' ';
      out << '\n';
    }
  }
  const double before = cpu_seconds();
  for (long k = std::lround(timed / dt); k > 0; --k) box.step(dt);
  std::printf("%.6f\n", cpu_seconds() - before);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  dInitODE2(0);
  dAllocateODEDataForThread(dAllocateMaskAll);
  const std::string task = argc > 1 ? argv[1] : "";
  if (task == "squeeze" && argc == 7) return squeeze(argv + 2);
  if (task == "run" && argc == 9) return run(argv + 2);
  std::cerr << "ode_rods squeeze IN OUT dt squeeze rest | ode_rods run IN FRAMES dt warm_up timed frames every\n";
  return 2;
}
