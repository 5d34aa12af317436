// SPDX-License-Identifier: MIT
#include "scene/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "scene/canonical.h"
#include "scene/document.h"
#include "scene/draft.h"
#include "scene/load.h"
#include "scene/nearest.h"
#include "scene/resolve.h"
#include "scene/settings.h"
#include "scene/values.h"

namespace shaken::scene {

namespace {

constexpr int kMaxReplicas = 10000;

/// One swept path, with the value that it takes in each choice of its factor (a single one in a list).
struct Axis {
  std::string path;
  Place key;
  std::vector<Node> values;
};

/// Paths that vary together; the sweep is the product of its factors.
struct Factor {
  enum class Kind { kGrid, kZip, kList, kRandom };
  Kind kind = Kind::kGrid;
  std::size_t n_choices = 0;
  std::vector<Axis> axes;
  /// Lists only (n_choices): the axes that take part in each choice.
  std::vector<std::vector<std::size_t>> members;
};

std::string name_of(Factor::Kind kind) {
  switch (kind) {
    case Factor::Kind::kGrid:
      return "grid";
    case Factor::Kind::kZip:
      return "zip";
    case Factor::Kind::kList:
      return "list";
    case Factor::Kind::kRandom:
      return "random";
  }
  return "";
}

class SweepReader {
 public:
  explicit SweepReader(std::vector<Problem>& problems) : problems_(problems) {}

  void read_sweep(const Node& sweep) {
    if (!expect(sweep, Node::Kind::kObject, "sweep", "an object")) return;
    for (const Member& member : sweep.members) {
      if (member.key == "grid") {
        read_grid(member.value);
      } else if (member.key == "zip") {
        read_zip(member.value);
      } else if (member.key == "list") {
        read_list(member.value);
      } else if (member.key == "random") {
        read_random(member.value);
      } else if (member.key == "replicas") {
        replicas_ = read_count("sweep.replicas", member.value, 1, kMaxReplicas, problems_).value_or(1);
      } else {
        const std::vector<std::string> names{"grid", "zip", "list", "random", "replicas"};
        complain(member.place, "sweep." + member.key, "unknown key" + did_you_mean(nearest(member.key, names)));
      }
    }
  }

  void set_replicas(int replicas) {
    replicas_ = replicas;
    if (replicas >= 1 && replicas <= kMaxReplicas) return;
    const Place flag{std::make_shared<const std::string>(fmt::format("--replicas {}", replicas)), 0, 0};
    complain(flag, {}, fmt::format("{} is outside [1, {}]", replicas, kMaxReplicas));
    replicas_ = 1;
  }

  void apply_setting(const Setting& setting, Draft& base) {
    const int index = field_index(setting.path);
    if (index < 0 || fields()[static_cast<std::size_t>(index)].form == Form::kBlock) {
      return base.assign(setting.path, setting.place, setting.value, problems_);
    }
    const std::vector<Node> values = read_values(fields()[static_cast<std::size_t>(index)], setting.value, problems_);
    if (values.empty()) return;
    const auto swept = std::find_if(factors_.begin(), factors_.end(), [&](const Factor& factor) {
      return std::any_of(factor.axes.begin(), factor.axes.end(),
                         [&](const Axis& axis) { return axis.path == setting.path; });
    });
    if (swept != factors_.end() && swept->kind != Factor::Kind::kGrid) {
      return complain(
          setting.place, setting.path,
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
      complain(base.place(), {},
               fmt::format("the sweep has more than {} points: {} x {} replicas", kMaxPoints, product, replicas_));
      return {};
    }
    const bool seed_is_swept = std::any_of(factors_.begin(), factors_.end(), [](const Factor& factor) {
      return std::any_of(factor.axes.begin(), factor.axes.end(), [](const Axis& a) { return a.path == "time.seed"; });
    });
    if (seed_is_swept && replicas_ > 1) {
      complain(base.place(), "time.seed", "time.seed is swept and there are replicas, which vary it too; remove one");
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
  void complain(const Place& place, std::string_view path, std::string message) {
    problems_.push_back(problem_at(place, path, std::move(message)));
  }

  bool expect(const Node& node, Node::Kind kind, std::string_view path, std::string_view what) {
    if (node.kind == kind) return true;
    complain(node.place, path, fmt::format("expected {}, not {}", what, describe(node)));
    return false;
  }

  /// The field that `member`'s key names, if it can be swept and is not yet.
  const Field* swept_field(const Member& member) {
    const int index = field_index(member.key);
    if (index < 0 || fields()[static_cast<std::size_t>(index)].form == Form::kBlock) {
      const bool exists = index >= 0 || is_group(member.key);
      complain(member.place, member.key,
               exists ? "this is an object; sweep the keys in it" : "unknown key" + suggest_path(member.key));
      return nullptr;
    }
    for (const Factor& factor : factors_) {
      for (const Axis& axis : factor.axes) {
        if (axis.path != member.key) continue;
        complain(member.place, member.key,
                 fmt::format("swept twice, in \"{}\" at {}:{} before", name_of(factor.kind), axis.key.line,
                             axis.key.column));
        return nullptr;
      }
    }
    return &fields()[static_cast<std::size_t>(index)];
  }

  void read_grid(const Node& grid) {
    if (!expect(grid, Node::Kind::kObject, "sweep.grid", "an object of paths and values")) return;
    for (const Member& member : grid.members) {
      if (const Field* field = swept_field(member)) {
        const std::vector<Node> values = read_values(*field, member.value, problems_);
        factors_.push_back({Factor::Kind::kGrid, values.size(), {{member.key, member.place, values}}, {}});
      }
    }
  }

  void read_zip(const Node& zip) {
    if (!expect(zip, Node::Kind::kObject, "sweep.zip", "an object of paths and values")) return;
    Factor factor{Factor::Kind::kZip, 0, {}, {}};
    for (const Member& member : zip.members) {
      const Field* field = swept_field(member);
      if (!field) continue;
      Axis axis{member.key, member.place, read_values(*field, member.value, problems_)};
      if (axis.values.empty()) continue;
      if (!factor.axes.empty() && axis.values.size() != factor.n_choices) {
        complain(member.place, member.key,
                 fmt::format("{} values, but {} has {}; paths of a zip vary together", axis.values.size(),
                             factor.axes.front().path, factor.n_choices));
        continue;
      }
      factor.n_choices = axis.values.size();
      factor.axes.push_back(std::move(axis));
    }
    if (!factor.axes.empty()) factors_.push_back(std::move(factor));
  }

  void read_list(const Node& list) {
    if (!expect(list, Node::Kind::kArray, "sweep.list", "an array of objects")) return;
    Factor factor{Factor::Kind::kList, 0, {}, {}};
    for (const Node& entry : list.items) {
      if (!expect(entry, Node::Kind::kObject, "sweep.list", "an object of paths and values")) continue;
      factor.members.emplace_back();
      for (const Member& member : entry.members) {
        if (!swept_field(member)) continue;
        factor.members.back().push_back(factor.axes.size());
        factor.axes.push_back({member.key, member.place, {member.value}});
      }
      ++factor.n_choices;
    }
    if (factor.n_choices > 0) factors_.push_back(std::move(factor));
  }

  void read_random(const Node& random) {
    if (!expect(random, Node::Kind::kObject, "sweep.random", "an object")) return;
    int n = 0;
    int seed = 1;
    if (const Member* member = random.find("n")) {
      n = read_count("sweep.random.n", member->value, 1, kMaxPoints, problems_).value_or(0);
    } else {
      complain(random.place, "sweep.random", "lacks \"n\", the number of draws");
    }
    if (const Member* member = random.find("seed")) {
      seed = read_count("sweep.random.seed", member->value, 0, 1 << 30, problems_).value_or(1);
    }
    Factor factor{Factor::Kind::kRandom, static_cast<std::size_t>(n), {}, {}};
    for (const Member& member : random.members) {
      if (member.key == "n" || member.key == "seed") continue;
      if (const Field* field = swept_field(member)) {
        std::vector<Node> values = draw_values(*field, member.value, n, static_cast<std::uint64_t>(seed), problems_);
        if (!values.empty()) factor.axes.push_back({member.key, member.place, std::move(values)});
      }
    }
    if (!factor.axes.empty()) factors_.push_back(std::move(factor));
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
      return complain(given ? given->place : base.place(), "time.seed",
                      fmt::format("{} replicas lead past the largest seed, {:.16g}", replicas_, seed.high));
    }
    const std::string label = point.label;
    for (point.replica = 1; point.replica <= replicas_; ++point.replica) {
      point.plan.system.seed = plan->system.seed + static_cast<std::uint64_t>(point.replica - 1);
      if (replicas_ > 1) point.label = fmt::format("{}{}replica={}", label, label.empty() ? "" : " ", point.replica);
      made.push_back(point);
    }
  }

  std::vector<Problem>& problems_;
  std::vector<Factor> factors_;
  int replicas_ = 1;
};

}  // namespace

Loaded<Sweep> load_sweep(std::string_view text, const std::string& file, std::span<const std::string> settings,
                         std::optional<int> replicas) {
  std::vector<Problem> problems;
  const std::optional<Node> root = parse_document(text, file, problems);
  if (!root) return {std::nullopt, problems};

  Sweep sweep{std::filesystem::path(file).stem().string(), {}};
  Draft base(root->place);
  SweepReader reader(problems);
  if (!root->find("scene") && !root->find("sweep")) {
    base.read(*root, problems);
  } else {
    for (const Member& member : root->members) {
      if (member.key == "scene") {
        base.read(member.value, problems);
      } else if (member.key == "sweep") {
        reader.read_sweep(member.value);
      } else if (member.key == "name" && member.value.kind == Node::Kind::kString && !member.value.text.empty()) {
        sweep.name = member.value.text;
      } else if (member.key == "name") {
        problems.push_back(problem_at(member.value.place, "name", "expected a text, not " + describe(member.value)));
      } else {
        const std::vector<std::string> names{"name", "scene", "sweep"};
        const std::vector<std::string> inside = names_in({});
        const bool misplaced = std::find(inside.begin(), inside.end(), member.key) != inside.end();
        problems.push_back(problem_at(member.place, member.key,
                                      misplaced ? "in a sweep file this belongs into \"scene\""
                                                : "unknown key" + did_you_mean(nearest(member.key, names))));
      }
    }
  }
  if (replicas) reader.set_replicas(*replicas);
  for (const std::string& written : settings) {
    if (const auto setting = parse_setting(written, problems)) reader.apply_setting(*setting, base);
  }
  sweep.points = reader.points(base);
  if (!problems.empty()) return {std::nullopt, tidied(std::move(problems))};
  return {std::move(sweep), {}};
}

}  // namespace shaken::scene
