#include "scene/sweeps/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <unordered_map>

#include "base/keys/draft.h"
#include "base/text.h"
#include "scene/canonical.h"
#include "scene/keys/keys.h"
#include "scene/keys/settings.h"
#include "scene/keys/values.h"
#include "scene/length.h"
#include "scene/load.h"
#include "scene/resolve/resolve.h"
#include "scene/sweeps/factors.h"
#include "scene/sweeps/stages.h"
#include "scene/sweeps/sweep_keys.h"

namespace shaken::scene {

namespace {

/// Points are not looked at after so many problems: each takes its time, and kMaxProblems are told.
constexpr std::size_t kEnoughProblems = 1000;

/// Multiplies the products of a sweep out, one after the other.
class Products {
 public:
  Products(std::vector<Variation> products, Room& room, std::vector<Problem>& problems)
      : products_(std::move(products)), room_(room), problems_(problems) {}

  void set_replicas(int replicas) {
    const bool allowed = replicas >= 1 && replicas <= kMaxReplicas;
    if (!allowed) {
      const Place flag{std::make_shared<const std::string>(fmt::format("--replicas {}", replicas)), 0, 0};
      report(flag, {}, fmt::format("{} is outside [1, {}]", replicas, kMaxReplicas));
    }
    for (Variation& product : products_) product.replicas = allowed ? replicas : 1;
  }

  void apply_setting(const Setting& setting, Draft& base) {
    const int index = field_index(setting.path);
    if (index < 0 || fields()[static_cast<std::size_t>(index)].form == Form::kBlock) {
      return base.assign(setting.path, setting.place, setting.value, problems_);
    }
    const std::vector<Node> values =
        read_values(fields()[static_cast<std::size_t>(index)], setting.value, room_, problems_);
    if (values.empty()) return;
    for (Variation& product : products_) put_in_place(setting, values, product);
    if (values.size() == 1) base.assign(setting.path, setting.place, values.front(), problems_);
  }

  std::vector<SweepPoint> points(const Draft& base) {
    std::size_t n_points = 0;
    std::string written;
    for (const Variation& product : products_) {
      const std::size_t n_here = size_of(product);
      if (n_here == 0) return {};  // a problem is reported
      n_points += n_here;
      written += fmt::format("{}{}", written.empty() ? "" : " + ", describe_size(product));
      if (n_points > kMaxPoints) {
        report(base.place(), {}, fmt::format("the sweep has more than {} points: {}", kMaxPoints, written));
        return {};
      }
    }
    for (const Variation& product : products_) {
      const bool seed_is_swept = std::any_of(product.factors.begin(), product.factors.end(),
                                             [](const Factor& factor) { return factor.has("time.seed"); });
      if (!seed_is_swept || product.replicas == 1) continue;
      report(base.place(), "time.seed", "time.seed is swept and there are replicas, which vary it too; remove one");
      return {};
    }

    std::vector<SweepPoint> made;
    for (const Variation& product : products_) multiply_out(product, base, made);
    if (products_.size() > 1) keep_one_of_each_run(made);
    return made;
  }

 private:
  void report(const Place& place, std::string_view path, std::string message) {
    problems_.push_back(problem_at(place, path, std::move(message)));
  }

  /// In one product: the values of a setting take the place of the grid's axis of that path, or are a further axis; a
  /// single value is none, and holds in all stages.
  void put_in_place(const Setting& setting, const std::vector<Node>& values, Variation& product) {
    std::vector<Factor>& factors = product.factors;
    const auto swept =
        std::find_if(factors.begin(), factors.end(), [&](const Factor& factor) { return factor.has(setting.path); });
    if (swept != factors.end() && swept->kind != Factor::Kind::kGrid) {
      return report(setting.place, setting.path,
                    fmt::format("the file's \"{}\" sweeps it; a setting cannot take its place", name_of(swept->kind)));
    }
    for (Stage& stage : product.stages) {
      const auto of_stage = [&](const Axis& axis) { return axis.path == setting.path; };
      if (values.size() == 1) {
        std::erase_if(stage, of_stage);
      } else if (std::any_of(stage.begin(), stage.end(), of_stage)) {
        return report(setting.place, setting.path,
                      "the file's stages set it; a setting of one value would do so for all");
      }
    }
    Factor factor{Factor::Kind::kGrid, values.size(), {{setting.path, setting.place, values}}, {}};
    if (values.size() == 1) {
      if (swept != factors.end()) factors.erase(swept);
    } else if (swept == factors.end()) {
      factors.push_back(std::move(factor));
    } else {
      *swept = std::move(factor);
    }
  }

  /// The number of points; of a product of large numbers, which could overflow, some number above kMaxPoints.
  static std::size_t size_of(const Variation& product) {
    std::size_t n_points = static_cast<std::size_t>(product.replicas) * std::max<std::size_t>(product.stages.size(), 1);
    for (const Factor& factor : product.factors) {
      n_points = std::min<std::size_t>(n_points * factor.n_choices, std::size_t{1} << 40);
    }
    return n_points;
  }

  /// "3 (grid) x 2 (zip) x 1 replicas"
  static std::string describe_size(const Variation& product) {
    std::string text;
    for (const Factor& factor : product.factors) {
      text += fmt::format("{} ({}) x ", factor.n_choices, name_of(factor.kind));
    }
    if (!product.stages.empty()) text += fmt::format("{} stages x ", product.stages.size());
    return text + fmt::format("{} replicas", product.replicas);
  }

  void multiply_out(const Variation& product, const Draft& base, std::vector<SweepPoint>& made) {
    const std::vector<Factor>& factors = product.factors;
    std::vector<std::size_t> choice(factors.size(), 0);
    while (problems_.size() < kEnoughProblems) {
      add_point(product, base, choice, made);
      // The next combination; the last factor varies fastest.
      std::size_t f = factors.size();
      while (f > 0 && ++choice[f - 1] == factors[f - 1].n_choices) choice[--f] = 0;
      if (f == 0) return;
    }
  }

  /// Keeps the first of points that name the same run, which then goes on for as long as any of them.
  static void keep_one_of_each_run(std::vector<SweepPoint>& points) {
    std::unordered_map<std::string, RunPlan*> firsts;
    std::vector<SweepPoint> kept;
    kept.reserve(points.size());  // firsts point into it
    for (SweepPoint& point : points) {
      const auto [first, is_new] = firsts.try_emplace(run_id(point.plan), nullptr);
      if (is_new) {
        first->second = &kept.emplace_back(std::move(point)).plan;
      } else {
        *first->second = as_long_as_both(*first->second, point.plan);
      }
    }
    points = std::move(kept);
  }

  /// Gives a draft one value more, and puts it into the point's label and parameters.
  void assign(const Axis& axis, std::size_t choice, Draft& draft, SweepPoint& point) {
    draft.assign(axis.path, axis.key, axis.values[choice], problems_);
    const Given* given = draft.find(axis.path);
    if (!given || !given->ok) return;
    const nlohmann::ordered_json value = to_json(field_at(axis.path), given->value);
    const double* number = std::get_if<double>(&given->value);
    const std::string text = number              ? fmt::format("{}", *number)
                             : value.is_string() ? value.get<std::string>()
                                                 : value.dump();
    point.parameters[axis.path] = value;
    point.label += fmt::format("{}{}={}", point.label.empty() ? "" : " ", axis.path, text);
  }

  void add_point(const Variation& product, const Draft& base, const std::vector<std::size_t>& choice,
                 std::vector<SweepPoint>& made) {
    Draft draft = base;
    SweepPoint point;
    point.parameters = nlohmann::ordered_json::object();
    for (std::size_t f = 0; f < product.factors.size(); ++f) {
      const Factor& factor = product.factors[f];
      if (factor.members.empty()) {
        for (const Axis& axis : factor.axes) assign(axis, choice[f], draft, point);
      } else {
        for (const std::size_t a : factor.members[choice[f]]) assign(factor.axes[a], 0, draft, point);
      }
    }
    if (!product.stages.empty()) return add_stages(product, draft, point, made);
    if (const std::optional<RunPlan> plan = resolve(draft, problems_)) add_replicas(product, draft, *plan, point, made);
  }

  /// The runs of `plan`, one for each replica, to the end of `made`.
  void add_replicas(const Variation& product, const Draft& draft, const RunPlan& plan, SweepPoint point,
                    std::vector<SweepPoint>& made) {
    point.plan = plan;
    const Field& seed = field_at("time.seed");
    if (static_cast<double>(plan.system.seed) > seed.high - (product.replicas - 1)) {
      const Given* given = draft.find("time.seed");
      return report(given ? given->place : draft.place(), "time.seed",
                    fmt::format("{} replicas lead past the largest seed, {:.16g}", product.replicas, seed.high));
    }
    const std::string label = point.label;
    for (point.replica = 1; point.replica <= product.replicas; ++point.replica) {
      point.plan.system.seed = plan.system.seed + static_cast<std::uint64_t>(point.replica - 1);
      if (product.replicas > 1)
        point.label = fmt::format("{}{}replica={}", label, label.empty() ? "" : " ", point.replica);
      made.push_back(point);
    }
  }

  /// The chains of a protocol, stage by stage: all replicas of the first, of the second and so on.
  void add_stages(const Variation& product, const Draft& start, const SweepPoint& point,
                  std::vector<SweepPoint>& made) {
    const Protocol protocol(product.stages);
    const auto n_replicas = static_cast<std::size_t>(product.replicas);
    for (std::size_t k = 0; k < protocol.size() && problems_.size() < kEnoughProblems; ++k) {
      Draft draft = start;
      SweepPoint here = point;
      here.parameters["stage"] = k + 1;
      here.label += fmt::format("{}stage={}", here.label.empty() ? "" : " ", k + 1);
      for (const Axis& axis : protocol.settings(k)) assign(axis, 0, draft, here);
      if (k > 0) begin_where_another_ends(draft, problems_);
      std::optional<RunPlan> plan = resolve(draft, problems_);
      if (!plan) return;
      protocol.name_the_rest(*plan, here.parameters);
      if (k > 0) {
        const RunPlan& former = made[made.size() - n_replicas].plan;
        const Place place = protocol.place(k).value_or(draft.place());
        if (const std::string why = cannot_follow(*plan, former); !why.empty()) {
          return report(place, "stages", fmt::format("stage {} cannot follow stage {}: {}", k + 1, k, why));
        }
        plan->start->time = former.total_time();
      }
      const std::size_t n_before = made.size();
      add_replicas(product, draft, *plan, here, made);
      if (made.size() != n_before + n_replicas) return;  // a problem is reported
      for (std::size_t i = n_before; k > 0 && i < made.size(); ++i) {
        made[i].plan.start->run = run_id(made[i - n_replicas].plan);
      }
    }
  }

  std::vector<Variation> products_;
  Room& room_;
  std::vector<Problem>& problems_;
};

}  // namespace

std::optional<std::string> name_problem(std::string_view name) {
  static constexpr std::size_t kLongestName = 200;
  if (name == "." || name == "..")
    return fmt::format("a sweep cannot be named \"{}\", which stands for a folder in addresses", name);
  if (!name.empty() && name.size() <= kLongestName && name.find('/') == name.npos && printable(name) == name) return {};
  return fmt::format("a name has 1 to {} bytes of UTF-8, without '/' and control characters", kLongestName);
}

std::optional<std::string> id_problem(std::string_view name) {
  const bool is_like_an_id = name.size() > 1 && name.front() == 's' && name[1] != '0' &&
                             name.find_first_not_of("0123456789", 1) == std::string_view::npos;
  if (is_like_an_id) return fmt::format("'{}' could be mistaken for a sweep's id", name);
  constexpr std::size_t kDigitsOfARun = 16;
  if (name.size() == kDigitsOfARun && name.find_first_not_of("0123456789abcdef") == std::string_view::npos) {
    return fmt::format("'{}' could be mistaken for a job's id", name);
  }
  return {};
}

std::string sweep_name(std::string_view text, const std::string& file) {
  std::vector<Problem> ignored;
  const std::optional<Node> root = parse_document(text, file, ignored);
  if (root && (root->find("scene") != nullptr || root->find("sweep") != nullptr)) {
    const Member* name = root->find("name");
    if (name != nullptr && name->value.kind == Node::Kind::kString) return name->value.text;
  }
  return std::filesystem::path(file).stem().string();
}

Loaded<Sweep> load_sweep(std::string_view text, const std::string& file, std::span<const std::string> settings,
                         std::optional<int> replicas) {
  std::vector<Problem> problems;
  const std::optional<Node> root = parse_document(text, file, problems);
  if (!root) return problems;

  Sweep sweep{.name = std::filesystem::path(file).stem().string(), .points = {}};
  Place name_place{root->place.file, 0, 0};
  Draft base(fields(), root->place);
  std::vector<Variation> products{Variation{}};
  Room room;
  if (!root->find("scene") && !root->find("sweep")) {
    base.read(*root, problems);
  } else {
    const std::vector<std::string> inside = fields().names_in({});
    Node own;  // without what is in "scene" and "sweep", and without what should be
    own.kind = Node::Kind::kObject;
    for (const Member& member : root->members) {
      if (member.key == "scene") {
        base.read(member.value, problems);
      } else if (member.key == "sweep") {
        products = read_variations(member.value, room, problems);
      } else if (std::find(inside.begin(), inside.end(), member.key) != inside.end()) {
        problems.push_back(problem_at(member.place, member.key, "in a sweep file this belongs into \"scene\""));
      } else {
        own.members.push_back(member);
      }
    }
    Draft draft(sweep_keys(), root->place);
    draft.read(own, problems);
    sweep_keys().store(draft, sweep);
    if (const Given* name = draft.find("name"); name != nullptr && name->ok) name_place = name->place;
  }
  if (const auto problem = name_problem(sweep.name)) {
    // A name that is no text at all has been reported; that of the file stands in for it.
    const bool is_of_file = name_place.line == 0;
    problems.push_back(problem_at(name_place, is_of_file ? "" : "name",
                                  *problem + (is_of_file ? ": rename the file, or give a \"name\" in a sweep" : "")));
    return tidied(std::move(problems));  // before the points, of which there may be many
  }
  Products sweeps(std::move(products), room, problems);
  if (replicas) sweeps.set_replicas(*replicas);
  for (const std::string& written : settings) {
    if (const auto setting = parse_setting(written, problems)) sweeps.apply_setting(*setting, base);
  }
  sweep.points = sweeps.points(base);
  if (!problems.empty()) return tidied(std::move(problems));
  return sweep;
}

}  // namespace shaken::scene
