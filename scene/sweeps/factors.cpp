#include "scene/sweeps/factors.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/keys/nearest.h"
#include "scene/keys/fields.h"
#include "scene/keys/values.h"

namespace shaken::scene {

namespace {

struct NamedKind {
  std::string_view name;
  Factor::Kind kind;
};
constexpr auto kKinds = std::to_array<NamedKind>(
    {{"grid", Factor::Kind::kGrid}, {"zip", Factor::Kind::kZip}, {"list", Factor::Kind::kList}});

/// Reads one product, which stands at `path` ("sweep", "sweep.1").
class VariationReader {
 public:
  VariationReader(std::string path, Room& room, std::vector<Problem>& problems)
      : path_(std::move(path)), room_(room), problems_(problems) {}

  Variation read(const Node& sweep) {
    if (!expect(sweep, Node::Kind::kObject, path_, "an object")) return {};
    for (const Member& member : sweep.members) {
      const auto known =
          std::find_if(kKinds.begin(), kKinds.end(), [&](const NamedKind& one) { return one.name == member.key; });
      if (known != kKinds.end()) {
        read_factor(known->kind, member.value);
      } else if (member.key == "stages") {
        read_stages(member.value);
      } else if (member.key == "replicas") {
        variation_.replicas = read_count(within("replicas"), member.value, 1, kMaxReplicas, problems_).value_or(1);
      } else if (member.key == "random" || member.key == "latin" || member.key == "sobol") {
        report(
            member.place, within(member.key),
            "points that fill a space are entries of \"list\", which shaken.design in Python makes (docs/python.md)");
      } else {
        std::vector<std::string> names{"replicas", "stages"};
        for (const NamedKind& one : kKinds) names.emplace_back(one.name);
        const std::string meant = suggestion(problems_, [&] { return did_you_mean(nearest(member.key, names)); });
        report(member.place, within(member.key),
               "unknown key" + (meant.empty() ? fmt::format("; a sweep has {}", fmt::join(names, ", ")) : meant));
      }
    }
    for (const Stage& stage : variation_.stages) {
      for (const Axis& axis : stage) refuse_sweeping(axis.path, axis.key);
    }
    return std::move(variation_);
  }

 private:
  std::string within(std::string_view key) const { return fmt::format("{}.{}", path_, key); }

  void read_factor(Factor::Kind kind, const Node& node) {
    switch (kind) {
      case Factor::Kind::kGrid:
        return read_grid(node);
      case Factor::Kind::kZip:
        return read_zip(node);
      case Factor::Kind::kList:
        return read_list(node);
    }
  }

  void report(const Place& place, std::string_view path, std::string message) {
    problems_.push_back(problem_at(place, path, std::move(message)));
  }

  bool expect(const Node& node, Node::Kind kind, std::string_view path, std::string_view what) {
    if (node.kind == kind) return true;
    report(node.place, path, fmt::format("expected {}, not {}", what, describe(node)));
    return false;
  }

  /// The field that `member`'s key names, if it can be swept.
  const Field* field_of(const Member& member) {
    const int index = field_index(member.key);
    if (index < 0 || fields()[static_cast<std::size_t>(index)].form == Form::kBlock) {
      const bool exists = index >= 0 || fields().is_group(member.key);
      report(member.place, member.key,
             exists ? "this is an object; sweep the keys in it"
                    : "unknown key" + suggestion(problems_, [&] { return fields().suggest_path(member.key); }));
      return nullptr;
    }
    return &fields()[static_cast<std::size_t>(index)];
  }

  /// Whether a factor sweeps `path` already, which is a problem.
  bool refuse_sweeping(std::string_view path, const Place& key) {
    for (const Factor& factor : variation_.factors) {
      for (const Axis& axis : factor.axes) {
        if (axis.path != path) continue;
        report(
            key, path,
            fmt::format("swept twice, in \"{}\" at {}:{} too", name_of(factor.kind), axis.key.line, axis.key.column));
        return true;
      }
    }
    return false;
  }

  /// The field that `member`'s key names, if it can be swept and is not yet.
  const Field* swept_field(const Member& member) {
    const Field* field = field_of(member);
    return field && refuse_sweeping(member.key, member.place) ? nullptr : field;
  }

  /// An entry stands for one stage, or for as many as its keys have values: a ramp in steps.
  void read_stages(const Node& stages) {
    if (!expect(stages, Node::Kind::kArray, within("stages"), "an array of objects")) return;
    for (const Node& entry : stages.items) {
      if (!expect(entry, Node::Kind::kObject, within("stages"), "an object of paths and values")) continue;
      read_steps(entry);
    }
    if (stages.items.empty()) report(stages.place, within("stages"), "names no stage");
    if (variation_.stages.size() > kMaxStages) {
      report(stages.place, within("stages"),
             fmt::format("{} stages; at most {} are allowed", variation_.stages.size(), kMaxStages));
      variation_.stages.clear();
    }
  }

  void read_steps(const Node& entry) {
    std::vector<Axis> axes;
    std::size_t n_steps = 1;
    for (const Member& member : entry.members) {
      const Field* field = field_of(member);
      if (!field) continue;
      if (member.key == "time.seed" || member.key.starts_with("start") || member.key.starts_with("rods.start")) {
        report(member.place, member.key,
               "a stage begins where the one before ends, with the same seed: say this in \"scene\", for the first");
        continue;
      }
      Axis axis{member.key, member.place, read_values(*field, member.value, room_, problems_)};
      if (axis.values.empty()) continue;
      if (axis.values.size() > 1 && n_steps > 1 && axis.values.size() != n_steps) {
        report(member.place, member.key,
               fmt::format("{} values, but another key of this stage has {}; keys of a stage vary together",
                           axis.values.size(), n_steps));
        continue;
      }
      n_steps = std::max(n_steps, axis.values.size());
      axes.push_back(std::move(axis));
    }
    for (std::size_t step = 0; step < n_steps; ++step) {
      Stage& stage = variation_.stages.emplace_back();
      for (const Axis& axis : axes) {
        stage.push_back({axis.path, axis.key, {axis.values[axis.values.size() == 1 ? 0 : step]}});
      }
    }
  }

  void read_grid(const Node& grid) {
    if (!expect(grid, Node::Kind::kObject, within("grid"), "an object of paths and values")) return;
    for (const Member& member : grid.members) {
      if (const Field* field = swept_field(member)) {
        const std::vector<Node> values = read_values(*field, member.value, room_, problems_);
        variation_.factors.push_back({Factor::Kind::kGrid, values.size(), {{member.key, member.place, values}}, {}});
      }
    }
  }

  void read_zip(const Node& zip) {
    if (!expect(zip, Node::Kind::kObject, within("zip"), "an object of paths and values")) return;
    Factor factor{Factor::Kind::kZip, 0, {}, {}};
    for (const Member& member : zip.members) {
      const Field* field = swept_field(member);
      if (!field) continue;
      Axis axis{member.key, member.place, read_values(*field, member.value, room_, problems_)};
      if (axis.values.empty()) continue;
      if (!factor.axes.empty() && axis.values.size() != factor.n_choices) {
        report(member.place, member.key,
               fmt::format("{} values, but {} has {}; paths of a zip vary together", axis.values.size(),
                           factor.axes.front().path, factor.n_choices));
        continue;
      }
      factor.n_choices = axis.values.size();
      factor.axes.push_back(std::move(axis));
    }
    if (!factor.axes.empty()) variation_.factors.push_back(std::move(factor));
  }

  void read_list(const Node& list) {
    if (!expect(list, Node::Kind::kArray, within("list"), "an array of objects")) return;
    Factor factor{Factor::Kind::kList, 0, {}, {}};
    for (const Node& entry : list.items) {
      if (!expect(entry, Node::Kind::kObject, within("list"), "an object of paths and values")) continue;
      factor.members.emplace_back();
      for (const Member& member : entry.members) {
        if (!swept_field(member)) continue;
        factor.members.back().push_back(factor.axes.size());
        factor.axes.push_back({member.key, member.place, {member.value}});
      }
      ++factor.n_choices;
    }
    if (factor.n_choices > 0) variation_.factors.push_back(std::move(factor));
  }

  std::string path_;
  Room& room_;
  std::vector<Problem>& problems_;
  Variation variation_;
};

}  // namespace

bool Factor::has(std::string_view path) const {
  return std::any_of(axes.begin(), axes.end(), [&](const Axis& axis) { return axis.path == path; });
}

std::string name_of(Factor::Kind kind) {
  for (const NamedKind& one : kKinds) {
    if (one.kind == kind) return std::string(one.name);
  }
  return "";
}

std::vector<Variation> read_variations(const Node& sweep, Room& room, std::vector<Problem>& problems) {
  if (sweep.kind != Node::Kind::kArray) return {VariationReader("sweep", room, problems).read(sweep)};
  std::vector<Variation> products;
  for (const Node& item : sweep.items) {
    products.push_back(VariationReader(fmt::format("sweep.{}", products.size()), room, problems).read(item));
  }
  if (!products.empty()) return products;
  problems.push_back(problem_at(sweep.place, "sweep", "an array of sweeps needs at least one"));
  return {Variation{}};
}

}  // namespace shaken::scene
