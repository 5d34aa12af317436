#include "run/loop/trouble_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/files.h"
#include "run/files/version.h"
#include "scene/canonical.h"

namespace shaken::run {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

std::string describe(const NumericalTrouble& trouble, double dt) {
  return fmt::format(
      "numerical trouble at tick {} ({:.6f} s), rods {}: {}; a shorter time.step helps, or, where rods "
      "pile up, contacts.sweeps 4",
      trouble.tick, static_cast<double>(trouble.tick) * dt, fmt::join(trouble.rods, ", "), trouble.what);
}

OrderedJson to_json(const CloseUp& close_up) {
  OrderedJson rods = OrderedJson::array();
  for (const CloseUp::Rod& rod : close_up.rods) {
    rods.push_back({{"rod", rod.rod},
                    {"concerned", rod.concerned},
                    {"position_mm", vector_json(rod.pose.position)},
                    {"director", vector_json(rod.pose.director)},
                    {"velocity_mm_s", vector_json(rod.motion.velocity)},
                    {"angular_velocity_rad_s", vector_json(rod.motion.angular_velocity)}});
  }
  OrderedJson contacts = OrderedJson::array();
  for (const CloseUp::Contact& contact : close_up.contacts) {
    OrderedJson json{{"rod", contact.rod}, {"bead", contact.bead}};
    if (contact.other >= 0) {
      json["other_rod"] = contact.other;
      json["other_bead"] = contact.other_bead;
    } else {
      json["surface"] = surface_name(contact.other);
    }
    json["overlap_mm"] = contact.overlap;
    json["approach_mm_s"] = contact.approach;
    contacts.push_back(std::move(json));
  }
  return {{"tick", close_up.tick},
          {"base_mm", close_up.plates.base},
          {"lid_mm", close_up.plates.lid},
          {"plate_velocity_mm_s", close_up.plates.velocity},
          {"lid_velocity_mm_s", close_up.plates.lid_velocity},
          {"rods", rods},
          {"contacts", contacts},
          {"unknown_rods", close_up.unknown}};
}

Result<void> write_trouble(const std::filesystem::path& file, const scene::RunPlan& plan, const TroubleReport& report) {
  const OrderedJson json{{"run_id", scene::run_id(plan)},
                         {"version", version()},
                         {"tick", report.trouble.tick},
                         {"time_s", static_cast<double>(report.trouble.tick) * plan.system.dt},
                         {"rods", report.trouble.rods},
                         {"what", report.trouble.what},
                         {"checkpoint_tick", report.checkpoint_tick},
                         {"before", to_json(report.before)},
                         {"scene", scene::to_json(plan)}};
  return write_file_atomically(file, json.dump(2) + "\n");
}

Result<TroubleReport> read_trouble(const std::filesystem::path& file) {
  const std::string text = SHAKEN_TRY(read_file(file));
  try {
    const OrderedJson json = OrderedJson::parse(text);
    TroubleReport report;
    report.trouble.tick = json.at("tick").get<Tick>();
    report.trouble.rods = json.at("rods").get<std::vector<int>>();
    report.trouble.what = json.at("what").get<std::string>();
    report.checkpoint_tick = json.at("checkpoint_tick").get<Tick>();
    return report;
  } catch (const OrderedJson::exception& problem) {
    return Error{file.string() + " cannot be read: " + problem.what()};
  }
}

}  // namespace shaken::run
