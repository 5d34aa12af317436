#include "scene/resolve/resolution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace shaken::scene {

namespace {

constexpr double kAgreement = 1e-6;  // relative

}  // namespace

double Resolution::number(std::string_view path) const {
  const Given* found = draft.find(path);
  return std::get<double>(found && found->ok ? found->value : field_at(path).fallback);
}

bool Resolution::ok(const Paths& paths) const {
  return std::all_of(paths.begin(), paths.end(), [&](const std::string& path) { return draft.is_ok(path); });
}

void Resolution::report(const Paths& paths, std::string message) {
  for (const std::string& path : paths) {
    if (const Given* found = draft.find(path)) {
      problems.push_back(problem_at(found->place, path, std::move(message)));
      return;
    }
  }
  problems.push_back(problem_at(draft.place(), paths.front(), std::move(message)));
}

void Resolution::check_derived(std::string_view path, const Paths& causes) {
  const Field& field = field_at(path);
  const double value = std::get<double>(field.fetch(plan));
  if (value >= field.low && value <= field.high) return;
  std::string said;
  for (const std::string& cause : causes) {
    const Field& given_field = field_at(cause);
    said += fmt::format("{}{} {}", said.empty() ? "" : " and ", cause, show(given_field, given_field.fetch(plan)));
  }
  report(causes, fmt::format("{} make {} {}, outside {}", said, path, show(field, value),
                             format_range(field.low, field.high, field.dimension)));
}

std::vector<RodGroup> rod_groups(System& system) {
  std::vector<RodGroup> groups{{"rods", system.rod, system.n_rods}};
  for (std::size_t k = 0; k < system.added.size(); ++k) {
    if (auto& added = system.added[k]) groups.push_back({fmt::format("rods_{}", k + 2), added->rod, added->count});
  }
  return groups;
}

bool agree(double a, double b) { return std::abs(a - b) <= kAgreement * std::max(std::abs(a), std::abs(b)); }

std::string length_text(double value) { return format_quantity(value, Dimension::kLength); }
std::string time_text(double value) { return format_quantity(value, Dimension::kTime); }

}  // namespace shaken::scene
