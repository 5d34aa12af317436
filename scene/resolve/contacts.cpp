#include <fmt/format.h>

#include <initializer_list>
#include <optional>

#include "scene/resolve/resolution.h"

namespace shaken::scene {

namespace {

/// The name of a group of rods, and whether the scene has it.
struct Group {
  std::string name;
  bool is_there;
};

/// Reports keys beneath `path` that are given though `group` is missing.
void check_group(Resolution& scene, const std::string& path, const Group& group,
                 std::initializer_list<const char*> keys = {".friction", ".restitution", ".restitution_speed"}) {
  if (group.is_there) return;
  for (const char* key : keys) {
    if (!scene.given(path + key)) continue;
    scene.report({path + key}, fmt::format("{}{} is about {}, which the scene does not have; add {} or remove the key",
                                           path, key, group.name, group.name));
    return;
  }
}

void forget_if_equal(std::optional<double>& own, double common) {
  if (own && *own == common) own.reset();
}

void forget_what_is_common(Contacts& contacts) {
  for (OwnContact& own : contacts.own) {
    forget_if_equal(own.friction, contacts.friction);
    forget_if_equal(own.restitution, contacts.restitution);
    forget_if_equal(own.restitution_speed, contacts.restitution_speed);
  }
}

}  // namespace

void resolve_contacts(Resolution& scene) {
  System& system = scene.plan.system;
  const Group second{"rods_2", system.has_species(1)};
  const Group third{"rods_3", system.has_species(2)};
  for (const Group& group : {second, third}) {
    for (const char* surface : {"contacts.rod_base.", "contacts.rod_lid.", "walls.", "posts."})
      check_group(scene, surface + group.name, group);
    check_group(scene, "plates." + group.name, group, {".noise"});
    check_group(scene, "contacts.rod_rod.rods_" + group.name, group);
    check_group(scene, "contacts.rod_rod." + group.name + "_" + group.name, group);
  }
  check_group(scene, "contacts.rod_rod.rods_2_rods_3", second.is_there ? third : second);

  for (Contacts* contacts : {&system.rod_rod, &system.rod_base, &system.rod_lid}) forget_what_is_common(*contacts);
  for (std::optional<double>& own : system.added_noise) forget_if_equal(own, system.rotational_noise);
  if (system.walls) forget_what_is_common(system.walls->contact);
  if (system.posts) forget_what_is_common(system.posts->contact);
}

}  // namespace shaken::scene
