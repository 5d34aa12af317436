// SPDX-License-Identifier: MIT
#include "scene/factors.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/fields.h"
#include "scene/nearest.h"
#include "scene/values.h"

namespace shaken::scene {

namespace {

class VariationReader {
 public:
  VariationReader(Room& room, std::vector<Problem>& problems) : room_(room), problems_(problems) {}

  Variation read(const Node& sweep) {
    if (!expect(sweep, Node::Kind::kObject, "sweep", "an object")) return {};
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
        variation_.replicas = read_count("sweep.replicas", member.value, 1, kMaxReplicas, problems_).value_or(1);
      } else {
        const std::vector<std::string> names{"grid", "zip", "list", "random", "replicas"};
        const std::string meant = suggestion(problems_, [&] { return did_you_mean(nearest(member.key, names)); });
        report(member.place, "sweep." + member.key, "unknown key" + meant);
      }
    }
    return std::move(variation_);
  }

 private:
  void report(const Place& place, std::string_view path, std::string message) {
    problems_.push_back(problem_at(place, path, std::move(message)));
  }

  bool expect(const Node& node, Node::Kind kind, std::string_view path, std::string_view what) {
    if (node.kind == kind) return true;
    report(node.place, path, fmt::format("expected {}, not {}", what, describe(node)));
    return false;
  }

  /// The field that `member`'s key names, if it can be swept and is not yet.
  const Field* swept_field(const Member& member) {
    const int index = field_index(member.key);
    if (index < 0 || fields()[static_cast<std::size_t>(index)].form == Form::kBlock) {
      const bool exists = index >= 0 || is_group(member.key);
      report(member.place, member.key,
             exists ? "this is an object; sweep the keys in it"
                    : "unknown key" + suggestion(problems_, [&] { return suggest_path(member.key); }));
      return nullptr;
    }
    for (const Factor& factor : variation_.factors) {
      for (const Axis& axis : factor.axes) {
        if (axis.path != member.key) continue;
        report(member.place, member.key,
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
        const std::vector<Node> values = read_values(*field, member.value, room_, problems_);
        variation_.factors.push_back({Factor::Kind::kGrid, values.size(), {{member.key, member.place, values}}, {}});
      }
    }
  }

  void read_zip(const Node& zip) {
    if (!expect(zip, Node::Kind::kObject, "sweep.zip", "an object of paths and values")) return;
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
    if (factor.n_choices > 0) variation_.factors.push_back(std::move(factor));
  }

  void read_random(const Node& random) {
    if (!expect(random, Node::Kind::kObject, "sweep.random", "an object")) return;
    int n = 0;
    int seed = 1;
    if (const Member* member = random.find("n")) {
      n = read_count("sweep.random.n", member->value, 1, kMaxPoints, problems_).value_or(0);
    } else {
      report(random.place, "sweep.random", "lacks \"n\", the number of draws");
    }
    if (const Member* member = random.find("seed")) {
      seed = read_count("sweep.random.seed", member->value, 0, 1 << 30, problems_).value_or(1);
    }
    Factor factor{Factor::Kind::kRandom, static_cast<std::size_t>(n), {}, {}};
    for (const Member& member : random.members) {
      if (member.key == "n" || member.key == "seed") continue;
      if (const Field* field = swept_field(member)) {
        std::vector<Node> values =
            draw_values(*field, member.value, n, static_cast<std::uint64_t>(seed), room_, problems_);
        if (!values.empty()) factor.axes.push_back({member.key, member.place, std::move(values)});
      }
    }
    if (!factor.axes.empty()) variation_.factors.push_back(std::move(factor));
  }

  Room& room_;
  std::vector<Problem>& problems_;
  Variation variation_;
};

}  // namespace

bool Factor::has(std::string_view path) const {
  return std::any_of(axes.begin(), axes.end(), [&](const Axis& axis) { return axis.path == path; });
}

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

Variation read_variation(const Node& sweep, Room& room, std::vector<Problem>& problems) {
  return VariationReader(room, problems).read(sweep);
}

}  // namespace shaken::scene
