// SPDX-License-Identifier: MIT
#include "scene/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/text.h"
#include "scene/canonical.h"
#include "scene/document.h"
#include "scene/draft.h"
#include "scene/factors.h"
#include "scene/load.h"
#include "scene/nearest.h"
#include "scene/resolve.h"
#include "scene/settings.h"
#include "scene/values.h"

namespace shaken::scene {

namespace {

/// Multiplies a variation out.
class Product {
 public:
  Product(Variation variation, Room& room, std::vector<Problem>& problems)
      : factors_(std::move(variation.factors)), replicas_(variation.replicas), room_(room), problems_(problems) {}

  void set_replicas(int replicas) {
    replicas_ = replicas;
    if (replicas >= 1 && replicas <= kMaxReplicas) return;
    const Place flag{std::make_shared<const std::string>(fmt::format("--replicas {}", replicas)), 0, 0};
    report(flag, {}, fmt::format("{} is outside [1, {}]", replicas, kMaxReplicas));
    replicas_ = 1;
  }

  void apply_setting(const Setting& setting, Draft& base) {
    const int index = field_index(setting.path);
    if (index < 0 || fields()[static_cast<std::size_t>(index)].form == Form::kBlock) {
      return base.assign(setting.path, setting.place, setting.value, problems_);
    }
    const std::vector<Node> values =
        read_values(fields()[static_cast<std::size_t>(index)], setting.value, room_, problems_);
    if (values.empty()) return;
    const auto swept =
        std::find_if(factors_.begin(), factors_.end(), [&](const Factor& factor) { return factor.has(setting.path); });
    if (swept != factors_.end() && swept->kind != Factor::Kind::kGrid) {
      return report(setting.place, setting.path,
                    fmt::format("the file's \"{}\" sweeps it; a setting cannot take its place", name_of(swept->kind)));
    }
    if (values.size() == 1) {
      if (swept != factors_.end()) factors_.erase(swept);
      return base.assign(setting.path, setting.place, values.front(), problems_);
    }
    Factor factor{Factor::Kind::kGrid, values.size(), {{setting.path, setting.place, values}}, {}};
    if (swept == factors_.end()) {
      factors_.push_back(std::move(factor));
    } else {
      *swept = std::move(factor);
    }
  }

  std::vector<SweepPoint> points(const Draft& base) {
    // The number of points, with the overflow of a product of large numbers in mind.
    std::size_t n_points = static_cast<std::size_t>(replicas_);
    for (const Factor& factor : factors_) {
      if (factor.n_choices == 0) return {};  // complained about
      n_points = std::min<std::size_t>(n_points * factor.n_choices, std::size_t{1} << 40);
    }
    if (n_points > kMaxPoints) {
      std::string product;
      for (const Factor& factor : factors_) {
        product += fmt::format("{}{} ({})", product.empty() ? "" : " x ", factor.n_choices, name_of(factor.kind));
      }
      report(base.place(), {},
             fmt::format("the sweep has more than {} points: {} x {} replicas", kMaxPoints, product, replicas_));
      return {};
    }
    const bool seed_is_swept =
        std::any_of(factors_.begin(), factors_.end(), [](const Factor& factor) { return factor.has("time.seed"); });
    if (seed_is_swept && replicas_ > 1) {
      report(base.place(), "time.seed", "time.seed is swept and there are replicas, which vary it too; remove one");
      return {};
    }

    std::vector<SweepPoint> made;
    std::vector<std::size_t> choice(factors_.size(), 0);
    while (true) {
      add_point(base, choice, made);
      // The next combination; the last factor varies fastest.
      std::size_t f = factors_.size();
      while (f > 0 && ++choice[f - 1] == factors_[f - 1].n_choices) choice[--f] = 0;
      if (f == 0) return made;
    }
  }

 private:
  void report(const Place& place, std::string_view path, std::string message) {
    problems_.push_back(problem_at(place, path, std::move(message)));
  }

  void add_point(const Draft& base, const std::vector<std::size_t>& choice, std::vector<SweepPoint>& made) {
    Draft draft = base;
    SweepPoint point;
    point.parameters = nlohmann::ordered_json::object();
    const auto apply = [&](const Axis& axis, std::size_t i) {
      draft.assign(axis.path, axis.key, axis.values[i], problems_);
      const Given* given = draft.find(axis.path);
      if (!given || !given->ok) return;
      const Field& field = field_at(axis.path);
      const nlohmann::ordered_json value = to_json(field, given->value);
      const double* number = std::get_if<double>(&given->value);
      const std::string text = number              ? fmt::format("{}", *number)
                               : value.is_string() ? value.get<std::string>()
                                                   : value.dump();
      point.parameters[axis.path] = value;
      point.label += fmt::format("{}{}={}", point.label.empty() ? "" : " ", axis.path, text);
    };
    for (std::size_t f = 0; f < factors_.size(); ++f) {
      const Factor& factor = factors_[f];
      if (factor.members.empty()) {
        for (const Axis& axis : factor.axes) apply(axis, choice[f]);
      } else {
        for (const std::size_t a : factor.members[choice[f]]) apply(factor.axes[a], 0);
      }
    }
    const std::optional<RunPlan> plan = resolve(draft, problems_);
    if (!plan) return;
    point.plan = *plan;
    const Field& seed = field_at("time.seed");
    if (static_cast<double>(plan->system.seed) > seed.high - (replicas_ - 1)) {
      const Given* given = draft.find("time.seed");
      return report(given ? given->place : base.place(), "time.seed",
                    fmt::format("{} replicas lead past the largest seed, {:.16g}", replicas_, seed.high));
    }
    const std::string label = point.label;
    for (point.replica = 1; point.replica <= replicas_; ++point.replica) {
      point.plan.system.seed = plan->system.seed + static_cast<std::uint64_t>(point.replica - 1);
      if (replicas_ > 1) point.label = fmt::format("{}{}replica={}", label, label.empty() ? "" : " ", point.replica);
      made.push_back(point);
    }
  }

  std::vector<Factor> factors_;
  int replicas_;
  Room& room_;
  std::vector<Problem>& problems_;
};

}  // namespace

std::optional<std::string> name_problem(std::string_view name) {
  static constexpr std::size_t kLongestName = 200;
  if (!name.empty() && name.size() <= kLongestName && name.find('/') == name.npos && printable(name) == name) return {};
  return fmt::format("a name has 1 to {} bytes of UTF-8, without '/' and control characters", kLongestName);
}

Loaded<Sweep> load_sweep(std::string_view text, const std::string& file, std::span<const std::string> settings,
                         std::optional<int> replicas) {
  std::vector<Problem> problems;
  const std::optional<Node> root = parse_document(text, file, problems);
  if (!root) return problems;

  Sweep sweep{std::filesystem::path(file).stem().string(), {}};
  Place name_place{root->place.file, 0, 0};
  Draft base(root->place);
  Variation variation;
  Room room;
  if (!root->find("scene") && !root->find("sweep")) {
    base.read(*root, problems);
  } else {
    const std::vector<std::string> names{"name", "scene", "sweep"}, inside = names_in({});
    for (const Member& member : root->members) {
      if (member.key == "scene") {
        base.read(member.value, problems);
      } else if (member.key == "sweep") {
        variation = read_variation(member.value, room, problems);
      } else if (member.key == "name" && member.value.kind == Node::Kind::kString) {
        sweep.name = member.value.text;
        name_place = member.value.place;
      } else if (member.key == "name") {
        problems.push_back(problem_at(member.value.place, "name", "expected a text, not " + describe(member.value)));
      } else {
        const std::string meant = suggestion(problems, [&] { return did_you_mean(nearest(member.key, names)); });
        const bool misplaced = std::find(inside.begin(), inside.end(), member.key) != inside.end();
        problems.push_back(
            problem_at(member.place, member.key,
                       misplaced ? "in a sweep file this belongs into \"scene\"" : "unknown key" + meant));
      }
    }
  }
  if (const auto problem = name_problem(sweep.name)) {
    // A name that is no text at all has been complained about; that of the file stands in for it.
    const bool is_of_file = name_place.line == 0;
    problems.push_back(problem_at(name_place, is_of_file ? "" : "name",
                                  *problem + (is_of_file ? ": rename the file, or give a \"name\" in a sweep" : "")));
  }
  Product product(std::move(variation), room, problems);
  if (replicas) product.set_replicas(*replicas);
  for (const std::string& written : settings) {
    if (const auto setting = parse_setting(written, problems)) product.apply_setting(*setting, base);
  }
  sweep.points = product.points(base);
  if (!problems.empty()) return tidied(std::move(problems));
  return sweep;
}

}  // namespace shaken::scene
