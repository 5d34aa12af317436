// Every key of a scene but those of observables, which scene/keys/observables.cpp has.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/picture_limits.h"
#include "scene/keys/accuracy_levels.h"
#include "scene/keys/derived.h"
#include "scene/keys/fields.h"
#include "scene/keys/observables.h"

namespace shaken::scene {

namespace {

using Fetch = Value (*)(const RunPlan&);
using enum Dimension;

/// A value of the system.
template <auto... steps>
inline constexpr auto sys = at<&RunPlan::system, steps...>;

/// Shown so that 7 stays 7 after a way through amplitude and frequency.
double to_ten_digits(double value) { return parse_decimal(fmt::format("{:.10g}", value)).value().value(); }

/// A key that is given in place of another: it has no place in a plan.
Field instead(const std::string& path, Fetch fetch, Dimension dimension, double low, double high, Value fallback,
              const std::string& doc) {
  return {{.path = path, .dimension = dimension, .low = low, .high = high, .fallback = std::move(fallback), .doc = doc},
          fetch};
}

/// A word for what other keys say in numbers.
Field accuracy() {
  Field field{{.path = "accuracy", .form = Form::kName, .fallback_note = "none"}};
  std::string steps;
  for (const AccuracyLevel& level : accuracy_levels()) {
    field.names.emplace_back(level.name);
    steps +=
        fmt::format("{}{} {}{}", steps.empty() ? "" : ", ", level.name, format_quantity(level.step, Dimension::kTime),
                    level.impacts == System{}.impacts ? "" : fmt::format(" with impacts {}", name_of(level.impacts)));
  }
  field.doc = fmt::format("Named level of accuracy, in place of `time.step` and `time.impacts`: {}.", steps);
  return field;
}

Field gravity() {
  Field field = quantity("gravity", sys<&System::gravity>, kAcceleration, 100, 1e5,
                         "Gravitational acceleration g, downwards. If it is 0, amplitude and frequency must set the "
                         "vibration.");
  field.or_zero = true;
  return field;
}

Field inner_wall() {
  Field field = quantity("walls.inner", sys<&System::walls, &SideWalls::inner>, kLength, 0.1, 2000,
                         "Diameter of the inner wall of an annulus.");
  field.fallback = SideWalls{}.inner;
  field.fetch = [](const RunPlan& p) {
    return p.system.walls->arena == Arena::kAnnulus ? Value(p.system.walls->inner) : Value();
  };
  return field;
}

Field length_of_arena() {
  Field field =
      derived(called("length of the arena", "",
                     quantity("walls.length", sys<&System::walls, &SideWalls::length>, kLength, 0, 2000,
                              "Length along x: of a stadium's straight walls, of an ellipse, or of a wedge.")),
              "so that the arena is twice as long as wide");
  field.fetch = [](const RunPlan& p) { return p.system.walls->has_length() ? Value(p.system.walls->length) : Value(); };
  return field;
}

Field narrow_end() {
  Field field = called("narrow end of the wedge", "",
                       quantity("walls.narrow", sys<&System::walls, &SideWalls::narrow>, kLength, 0, 2000,
                                "Width of a wedge at its narrow end, at larger x; 0: a triangle."));
  field.fallback = SideWalls{}.narrow;
  field.fetch = [](const RunPlan& p) {
    return p.system.walls->arena == Arena::kWedge ? Value(p.system.walls->narrow) : Value();
  };
  return field;
}

/// A number of sites along one axis; nothing where each place is given.
Field lattice_sites(const std::string& path, auto access, const std::string& doc) {
  Field field = whole(path, access, 1, 60, doc);
  field.fetch = [always = field.fetch](const RunPlan& p) {
    return p.system.posts->places.empty() ? always(p) : Value();
  };
  return field;
}

Field post_places() {
  return {{.path = "posts.places",
           .form = Form::kPairs,
           .dimension = kLength,
           .low = 0,
           .high = 2000,
           .most = 1000,
           .fallback_note = "none",
           .doc = "Where the axis of each post stands, from the corner of the box, in place of a lattice."},
          [](const RunPlan& p) {
            std::vector<std::array<double, 2>> places;
            for (const Vec2& place : p.system.posts->places) places.push_back({place.x(), place.y()});
            return places.empty() ? Value() : Value(places);
          },
          [](RunPlan& p, const Value& value) {
            p.system.posts->places.clear();
            for (const auto& [x, y] : std::get<std::vector<std::array<double, 2>>>(value))
              p.system.posts->places.emplace_back(x, y);
          }};
}

Field steady() {
  return {{.path = "time.steady",
           .dimension = kTime,
           .low = 0,
           .high = 1e7,
           .names = {"auto"},
           .doc = "Time before measuring begins. With \"auto\" it is determined from S(t) afterwards."},
          [](const RunPlan& plan) { return plan.steady ? Value(*plan.steady) : Value("auto"); },
          [](RunPlan& plan, const Value& value) {
            plan.steady.reset();
            if (const double* time = std::get_if<double>(&value)) plan.steady = *time;
          }};
}

/// Means nothing where another run has left the rods.
Field rods_start() {
  Field field =
      choice<Start>("rods.start", sys<&System::start>,
                    {{"aligned", Start::kAligned},
                     {"random", Start::kRandom},
                     {"compressed", Start::kCompressed},
                     {"polydomain", Start::kPolydomain},
                     {"defect_pair", Start::kDefectPair}},
                    "Whether rods start in rows, side by side; or at random places and directions (for dilute "
                    "systems); or so in a larger box, which is then compressed (dense and disordered); or compressed "
                    "along the directors of several domains, or of a pair of defects.");
  field.fallback = "aligned";
  field.fetch = [always = field.fetch](const RunPlan& plan) { return plan.start ? Value() : always(plan); };
  return field;
}

/// A key that means something with some starts only: nothing with others, and where another run has left the rods.
Field of_starts(Field field, std::initializer_list<Start> starts) {
  field.fetch = [always = field.fetch, of = std::vector<Start>(starts)](const RunPlan& plan) {
    return plan.start || std::ranges::find(of, plan.system.start) == of.end() ? Value() : always(plan);
  };
  return field;
}

Field rods_start_angle() {
  Field field =
      quantity("rods.start_angle", sys<&System::start_angle>, kPlain, -90, 90,
               "Angle in degrees to the x axis: of the rods of an aligned start, or of the director beyond a pair of "
               "defects. If it is 0 aligned rows lie along x, every other one shifted by half a rod; else they close "
               "around the periodic box as best they can.");
  field.fallback = 0.0;
  return later(of_starts(std::move(field), {Start::kAligned, Start::kDefectPair}));
}

Field rods_start_domains() {
  Field field = whole("rods.start_domains", sys<&System::start_domains>, 1, 10000,
                      "Number of domains of a polydomain start, of equal rank: their places and directors are random.");
  field.fallback = static_cast<double>(System{}.start_domains);
  return of_starts(std::move(field), {Start::kPolydomain});
}

Field rods_start_separation() {
  Field field = derived(quantity("rods.start_separation", sys<&System::start_separation>, kLength, 0.1, 2000,
                                 "Distance of the two defects of a pair, along the longer side of the box (x of a "
                                 "square)."),
                        "half the longer side");
  return of_starts(std::move(field), {Start::kDefectPair});
}

Field start_time() {
  Field field =
      derived(quantity("start.time", at<&RunPlan::start, &StartState::time>, kTime, 1e-7, 1e8,
                       "Simulated time at which that run ended, or was last saved: a whole number of vibrations. "
                       "0 of imported rods."),
              "must be given");
  field.or_zero = true;
  return field;
}

Field start_run() {
  return plain({.path = "start.run",
                .form = Form::kText,
                .pattern = "[0-9a-f]{16}",
                .longest = 16,
                .may_look_like_number = true,
                .expected = "the id of a run, 16 hex digits",
                .fallback_note = "must be given",
                .doc = "Id of the run whose rods are taken over, or that `shaken import` prints. It must have the same "
                       "rods, shape of the box, plates, walls and posts; side and gap (without walls and posts), "
                       "shaking, gravity, contacts, step and seed may differ."},
               at<&RunPlan::start, &StartState::run>);
}

Field movie_size() {
  Field field = size("movie.size", at<&RunPlan::movie, &Movie::width>, at<&RunPlan::movie, &Movie::height>,
                     kLeastPixels, kMostPixels, "Width and height in pixels, both even.");
  field.only_even = true;
  return field;
}

Value fetch_gamma(const RunPlan& p) {
  const std::optional<double> gamma = gamma_of(p.system);
  return gamma ? Value(to_ten_digits(*gamma)) : Value();
}

/// The diameters of all beads; nothing where a profile gives them.
template <class Access>
Field bead_diameters(const std::string& path, Access access) {
  return {{.path = path,
           .form = Form::kNumbers,
           .dimension = kLength,
           .low = 0.05,
           .high = 20,
           .fallback_note = "none",
           .doc = "Diameter of each bead from tail to head, in place of a profile."},
          [access](const RunPlan& p) { return access(p).empty() ? Value() : Value(access(p)); },
          [access](RunPlan& p, const Value& value) { access(p) = std::get<std::vector<double>>(value); }};
}

constexpr double kMostSpread = 0.3;  // the shortest rods then have half of the mean length
constexpr double kMostFriction = 1000;
constexpr double kMostNoise = 10;              // [rad/mm]
constexpr double kMostRestitutionSpeed = 1e6;  // [mm/s]

/// Area fraction of the rods added as number k + 2.
template <std::size_t k>
Value added_fraction(const RunPlan& p) {
  return Value(to_ten_digits(area_fraction_of(p.system, p.system.added[k]->rod, p.system.added[k]->count)));
}

// clang-format off

/// The shape of one species, which lies at `rod` in a plan.
template <auto... rod>
std::vector<Field> shape(const std::string& name, const std::string& of_density) {
  return {
    called("rod length", "ℓ",
    quantity(name + ".length", at<rod..., &RodShape::length>, kLength, 0.05, 50, "Length from tip to tip.")),
    called("middle diameter", "d",
    quantity(name + ".mid_diameter", at<rod..., &RodShape::mid_diameter>, kLength, 0.05, 20,
             "Diameter of the centre bead, or of the tail of a polar rod.")),
    called("end diameter", "d′",
    quantity(name + ".end_diameter", at<rod..., &RodShape::end_diameter>, kLength, 0.05, 20,
             "Diameter of the two end beads, or of the head of a polar rod.")),
    later(choice<Profile>(name + ".profile", at<rod..., &RodShape::profile>,
                          {{"symmetric", Profile::kSymmetric}, {"polar", Profile::kPolar}},
                          "Whether the thickness falls from the centre to both ends, or from tail to head.")),
    later(choice<Inertia>(name + ".inertia", at<rod..., &RodShape::inertia>,
                          {{"solid", Inertia::kSolid}, {"beads", Inertia::kBeads}},
                          "How the mass is distributed, which sets the moments of inertia: as in a uniform solid of the "
                          "union of the beads, or as in uniform beads added up.")),
    bead_diameters(name + ".bead_diameters", at<rod..., &RodShape::bead_diameters>),
    later(quantity(name + ".length_spread", at<rod..., &RodShape::spread, &SizeSpread::length>, kPlain, 0, kMostSpread,
                   "Standard deviation of the rods' lengths over their mean; of spheres, of their diameters.")),
    later(quantity(name + ".end_diameter_spread", at<rod..., &RodShape::spread, &SizeSpread::end_diameter>, kPlain, 0,
                   kMostSpread, "Standard deviation of the diameters of the rods' ends over their mean, independent of "
                                "their lengths.")),
    instead(name + ".bead_pitch", nullptr, kLength, 0.01, 10, kDefaultBeadPitch,
            "Largest distance between neighbouring beads; a rod gets the smallest odd number of beads that keeps to "
            "it."),
    derived(whole(name + ".beads", at<rod..., &RodShape::n_beads>, 1, kMostBeads,
                  "Number of beads, odd, in place of bead_pitch; 1 makes a sphere of diameter mid_diameter."),
            "from bead_pitch"),
    quantity(name + ".density", at<rod..., &RodShape::density>, kDensity, 0.001, 100,
             "Density of the material." + of_density),
  };
}

/// The rods that are added as number k + 2.
template <std::size_t k>
std::vector<Field> added_rods(const std::string& name) {
  std::vector<Field> rows{
    block(name, sys<&System::added, k>, false, "Rods of another species, at random places among the first.")};
  std::ranges::move(shape<&RunPlan::system, &System::added, k, &AddedRods::rod>(name, ""), std::back_inserter(rows));
  rows.push_back(
    called("area fraction", "φ",
    derived(instead(name + ".area_fraction", added_fraction<k>, kPlain, 1e-6, kMaxAreaFractionAligned, {},
                    "Area of these rods, lying flat, divided by the area of the box (or arena) that posts leave."),
            "from count")));
  rows.push_back(
    called("number of rods", "N",
    derived(whole(name + ".count", sys<&System::added, k, &AddedRods::count>, 1, 1e6, "Number of rods."),
            "from area_fraction")));
  return rows;
}

/// What the pair of species a and b, or a surface and species b, has of its own; the contacts lie at `steps` of the
/// system and have their keys beneath `name`.
template <std::size_t a, std::size_t b, auto... steps>
void add_own_contact(std::vector<Field>& rows, const std::string& name, const std::string& partners,
                     const std::string& between) {
  constexpr std::size_t place = Contacts::place(a, b);
  const std::string path = name + "." + partners;
  rows.push_back(derived(
    quantity(path + ".friction", sys<steps..., &Contacts::own, place, &OwnContact::friction>, kPlain, 0, kMostFriction,
             "Coefficient of Coulomb friction between " + between + "."), "that of " + name));
  rows.push_back(derived(
    quantity(path + ".restitution", sys<steps..., &Contacts::own, place, &OwnContact::restitution>, kPlain, 0, 1,
             "Coefficient of restitution between " + between + "."), "that of " + name));
  rows.push_back(called("", "", "mm/s", derived(
    quantity(path + ".restitution_speed", sys<steps..., &Contacts::own, place, &OwnContact::restitution_speed>, kPlain,
             0, kMostRestitutionSpeed, "The speed that `restitution_speed` is, between " + between + "."),
    "that of " + name)));
}

/// Friction and restitution of the contacts at `steps` of the system, with keys beneath `name`.
template <auto... steps>
std::vector<Field> contact(const std::string& name, const std::string& between) {
  return {
    quantity(name + ".friction", sys<steps..., &ContactParameters::friction>, kPlain, 0, kMostFriction,
             "Coefficient of Coulomb friction between " + between + "."),
    quantity(name + ".restitution", sys<steps..., &ContactParameters::restitution>, kPlain, 0, 1,
             "Coefficient of restitution between " + between + "."),
    called("", "", "mm/s",
    later(quantity(name + ".restitution_speed", sys<steps..., &ContactParameters::restitution_speed>, kPlain, 0,
                   kMostRestitutionSpeed,
                   "Speed in mm/s at which `restitution` is the coefficient, which falls with the speed of the impact "
                   "(docs/physics.md); 0: it is the same at every speed."))),
  };
}

/// Those of a surface, and what it has with each added species.
template <auto... steps>
std::vector<Field> surface_contact(const std::string& name, const std::string& surface) {
  std::vector<Field> rows = contact<steps...>(name, "rod and " + surface);
  add_own_contact<0, 1, steps...>(rows, name, "rods_2", "`rods_2` and " + surface);
  add_own_contact<0, 2, steps...>(rows, name, "rods_3", "`rods_3` and " + surface);
  return rows;
}

/// Those of two rods, and what each pair with an added species has.
std::vector<Field> rod_contact() {
  const std::string name = "contacts.rod_rod";
  std::vector<Field> rows = contact<&System::rod_rod>(name, "two rods");
  add_own_contact<0, 1, &System::rod_rod>(rows, name, "rods_rods_2", "`rods` and `rods_2`");
  add_own_contact<1, 1, &System::rod_rod>(rows, name, "rods_2_rods_2", "two of `rods_2`");
  add_own_contact<0, 2, &System::rod_rod>(rows, name, "rods_rods_3", "`rods` and `rods_3`");
  add_own_contact<1, 2, &System::rod_rod>(rows, name, "rods_2_rods_3", "`rods_2` and `rods_3`");
  add_own_contact<2, 2, &System::rod_rod>(rows, name, "rods_3_rods_3", "two of `rods_3`");
  return rows;
}

/// The noise of the rods that are added as number k + 2.
template <std::size_t k>
Field own_noise(const std::string& name) {
  const Field noise = quantity("plates." + name + ".noise", sys<&System::added_noise, k>, kPlain, 0, kMostNoise,
                               "Rotational noise of `" + name + "`, in rad/mm, as `plates.noise`.");
  return called("rotational noise of " + name, "ε_" + name.substr(5), "rad/mm", derived(noise, "that of plates.noise"));
}

/// The blocks of all observables.
std::vector<Field> measure() {
  std::vector<Field> rows{later(choice<MeasuredSpecies>(
    "measure.of", at<&RunPlan::of>, {{"rods", MeasuredSpecies::kFirst}, {"each", MeasuredSpecies::kEach}},
    "Whose observables are measured: those of `rods`, or those of each species by itself. What is found of `rods_2` and "
    "`rods_3` then has their names in front: number `rods_2.diffusion_mm2_s`, array `/rods_2/msd/total_mm2`."))};
  for (const Observable& observable : observables()) {
    rows.push_back(observable.block);
    rows.push_back(observable.every);
    rows.insert(rows.end(), observable.keys.begin(), observable.keys.end());
  }
  return rows;
}

/// All rows in canonical order, in groups.
std::vector<std::vector<Field>> groups() {
  return {
    shape<&RunPlan::system, &System::rod>("rods", " It sets the unit of energy; between species it is the ratio that matters."), {
    called("area fraction", "φ",
    instead("rods.area_fraction", [](const RunPlan& p) { return Value(to_ten_digits(area_fraction_of(p.system))); },
            kPlain, 1e-6, kMaxAreaFractionAligned, kDefaultAreaFraction,
            "Area of all rods, lying flat, divided by the area of the box (or arena) that posts leave.")),
    called("number of rods", "N",
    derived(whole("rods.count", sys<&System::n_rods>, 1, 1e6, "Number of rods."), "from area_fraction and side")),
    rods_start(),
    rods_start_angle(),
    rods_start_domains(),
    rods_start_separation(),
    }, added_rods<0>("rods_2"), added_rods<1>("rods_3"), {
    block("start", at<&RunPlan::start>, false,
          "The rods begin where another run has left them, in place of rows or random places; times count from there."),
    start_run(),
    start_time(),

    called("side of the box", "L",
    quantity("box.side", sys<&System::box_side>, kLength, 1, 2000,
             "Side L of the box along x. The box is periodic in x and y.")),
    called("aspect of the box", "L_y/L_x",
    later(quantity("box.aspect", sys<&System::box_aspect>, kPlain, 0.02, 50,
                   "Side of the box along y over that along x; 1: a square."))),
    called("gap between the plates", "w",
    quantity("box.gap", sys<&System::gap>, kLength, 0.05, 100, "Distance w between base and lid.")),

    called("shaking strength", "Γ",
    instead("plates.gamma", fetch_gamma, kPlain, 0, 200, kDefaultGamma,
            "Strength of shaking: the largest acceleration of the plates divided by gravity.")),
    called("amplitude of the plates", "a",
    derived(quantity("plates.amplitude", sys<&System::amplitude>, kLength, 0, 10,
                     "Amplitude a of the plates' vibration."),
            "from gamma and frequency")),
    called("frequency of the plates", "f",
    quantity("plates.frequency", sys<&System::frequency>, kFrequency, 0.1, 1e5,
             "Frequency f of the plates' vibration.")),
    gravity(),
    called("amplitude in the plane", "b",
    later(quantity("plates.horizontal_amplitude", sys<&System::horizontal_amplitude>, kLength, 0, 10,
                   "Amplitude b of the plates' vibration in the plane, at the same frequency; 0: none."))),
    called("phase of the vibration in the plane", "φ", "degrees",
    later(quantity("plates.horizontal_phase", sys<&System::horizontal_phase>, kPlain, -360, 360,
                   "Angle in degrees by which the vibration in the plane is ahead of that along z: 0 or 180 shake along "
                   "a line, 90 or -90 along an ellipse."))),
    called("direction of the vibration in the plane", "", "degrees",
    later(quantity("plates.horizontal_angle", sys<&System::horizontal_angle>, kPlain, -360, 360,
                   "Direction of the vibration in the plane, in degrees to the x axis."))),
    block("plates.second", sys<&System::second>, false,
          "A second vibration of the plates along z, which is added to the first. `plates.gamma` is that of the first."),
    called("amplitude of the second vibration", "a_2",
    quantity("plates.second.amplitude", sys<&System::second, &SecondVibration::amplitude>, kLength, 0, 10,
             "Amplitude a2 of the second vibration; 0: none.")),
    called("frequency of the second vibration", "f_2",
    quantity("plates.second.frequency", sys<&System::second, &SecondVibration::frequency>, kFrequency, 0.1, 1e5,
             "Its frequency f2.")),
    called("phase of the second vibration", "φ_2", "degrees",
    quantity("plates.second.phase", sys<&System::second, &SecondVibration::phase>, kPlain, -360, 360,
             "Its phase in degrees where the first vibration is at its highest, as at the start.")),
    block("plates.lid_motion", sys<&System::lid_motion>, false,
          "The lid does not move with the base: it rests, or vibrates along z with the same frequency by itself. "
          "`box.gap` is then the mean gap."),
    called("amplitude of the lid", "d",
    quantity("plates.lid_motion.amplitude", sys<&System::lid_motion, &LidMotion::amplitude>, kLength, 0, 10,
             "Amplitude of the lid's vibration; 0: it rests.")),
    called("phase of the lid", "ψ", "degrees",
    quantity("plates.lid_motion.phase", sys<&System::lid_motion, &LidMotion::phase>, kPlain, -360, 360,
             "Angle in degrees by which the lid is ahead of the base.")),
    called("inclination of the plates", "α", "degrees",
    later(quantity("plates.inclination", sys<&System::inclination>, kPlain, 0, 90,
                   "Angle in degrees of the plates to the horizontal. Gravity then has a part along them. z stays the "
                   "direction across the plates."))),
    called("direction down the slope", "", "degrees",
    later(quantity("plates.inclination_angle", sys<&System::inclination_angle>, kPlain, -360, 360,
                   "Direction down the slope, in degrees to the x axis."))),
    later(on_or_off("plates.base", sys<&System::base>, "Whether there is a base.")),
    later(on_or_off("plates.lid", sys<&System::lid>, "Whether there is a lid.")),
    called("rotational noise", "ε", "rad/mm",
    later(quantity("plates.noise", sys<&System::rotational_noise>, kPlain, 0, kMostNoise,
                   "Rotational noise in rad/mm: each hit by a plate changes the rod's angular velocity about the "
                   "vertical by this much per speed of the hit, to either side at random."))),
    own_noise<0>("rods_2"),
    own_noise<1>("rods_3"),

    block("walls", sys<&System::walls>, false,
          "Side walls around an arena in the middle of the box, in place of periodic boundaries; a channel "
          "goes on along x."),
    choice("walls.arena", sys<&System::walls, &SideWalls::arena>, kArenaNames, "Shape of the arena."),
    called("size of the arena", "",
    derived(quantity("walls.size", sys<&System::walls, &SideWalls::size>, kLength, 1, 2000,
                     "Diameter of the disc, of the outer wall or of a stadium's round ends, side of the square, or "
                     "width along y of the channel, of the ellipse or of the wedge's wide end."),
            "as large as the box allows")),
    inner_wall(),
    length_of_arena(),
    narrow_end(),
    },
    surface_contact<&System::walls, &SideWalls::contact>("walls", "wall"), {
    block("posts", sys<&System::posts>, false,
          "Round posts from base to lid that stand among the rods and move with the plates."),
    quantity("posts.diameter", sys<&System::posts, &Posts::diameter>, kLength, 0.05, 1000, "Diameter of each post."),
    lattice_sites("posts.columns", sys<&System::posts, &Posts::columns>,
                  "Posts side by side along x, in equal parts of the box or of the rectangle round the arena. Those that "
                  "would not stand wholly within the walls are left out."),
    lattice_sites("posts.rows", sys<&System::posts, &Posts::rows>, "The same along y."),
    post_places(),
    },
    surface_contact<&System::posts, &Posts::contact>("posts", "post"),
    rod_contact(),
    surface_contact<&System::rod_base>("contacts.rod_base", "base"),
    surface_contact<&System::rod_lid>("contacts.rod_lid", "lid"), {
    choice<ImpulseLaw>("contacts.law", sys<&System::law>,
                       {{"newton", ImpulseLaw::kNewton},
                        {"poisson", ImpulseLaw::kPoisson},
                        {"energetic", ImpulseLaw::kEnergetic}},
                       "Impulse law: whether restitution is a ratio of velocities, of impulses, or of works "
                       "(docs/stability.md)."),
    whole("contacts.sweeps", sys<&System::solver_sweeps>, 1, 100, "Number of passes over the contacts of one tick."),
    later(choice<ContactOrder>("contacts.order", sys<&System::order>,
                               {{"sorted", ContactOrder::kSorted},
                                {"reversed", ContactOrder::kReversed},
                                {"shuffled", ContactOrder::kShuffled}},
                               "Order in which the contacts of one tick get their impulses. No average should depend "
                               "on it.")),

    accuracy(),
    called("time step", "Δt",
    quantity("time.step", sys<&System::dt>, kTime, 1e-7, 1e-4,
             "Length of a tick (the time step). It determines the accuracy.")),
    choice<StepperKind>("time.engine", sys<&System::stepper>,
                   {{"scheduled", StepperKind::kScheduled}, {"reference", StepperKind::kReference}},
                   "Which stepper moves the rods. Both give bitwise the same trajectory."),
    later(choice<ImpactTime>("time.impacts", sys<&System::impacts>,
                             {{name_of(ImpactTime::kTickEnd), ImpactTime::kTickEnd},
                              {name_of(ImpactTime::kAtInstant), ImpactTime::kAtInstant}},
                             "Whether impacts take effect at the end of their tick, as in the paper, or at their own "
                             "instant within it.")),
    steady(),
    quantity("time.measure", at<&RunPlan::measure_time>, kTime, 1e-6, 1e7, "Length of the run after `time.steady`; of the whole run if that is \"auto\"."),
    whole("time.seed", sys<&System::seed>, 0, 9007199254740992.0,
          "Seed of all random numbers. Replica k of a sweep has seed + k - 1."),
    block("until", at<&RunPlan::until>, false,
          "The run goes on beyond `time.measure`, by a quarter each time, until S is known well enough."),
    quantity("until.order_sem", at<&RunPlan::until, &Until::order_sem>, kPlain, 1e-9, 1,
             "Largest standard error of the mean of S. S must also not be drifting."),
    quantity("until.at_most", at<&RunPlan::until, &Until::at_most>, kTime, 1e-6, 1e7,
             "Length of the run after `time.steady` at which it ends in any case."),
    },
    measure(), {
    block("trajectory", at<&RunPlan::trajectory>, false, "Positions and directions of the rods, in trajectory.h5."),
    every("trajectory.every", at<&RunPlan::trajectory, &Trajectory::every>, "Time between frames."),
    block("stream", at<&RunPlan::stream>, true,
          "Live state over LCM. It influences neither the results nor the name of the run."),
    quantity("stream.rate", at<&RunPlan::stream, &Stream::rate>, kFrequency, 0.1, 100,
             "Largest number of frames per second of wall-clock time."),
    block("movie", at<&RunPlan::movie>, false, "A movie of the finished run."),
    every("movie.every", at<&RunPlan::movie, &Movie::every>, "Simulated time between frames."),
    movie_size(),
    },
  };
}
// clang-format on

std::vector<Field> rows_of_scenes() {
  std::vector<Field> rows;
  for (std::vector<Field>& group : groups()) std::ranges::move(group, std::back_inserter(rows));
  return rows;
}

}  // namespace

const keys::Table<RunPlan>& fields() {
  static const keys::Table<RunPlan> table(rows_of_scenes());
  return table;
}

}  // namespace shaken::scene
