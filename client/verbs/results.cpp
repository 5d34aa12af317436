// SPDX-License-Identifier: MIT
#include "client/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "base/table.h"
#include "base/text.h"
#include "client/verbs/verbs.h"
#include "client/where.h"

namespace shaken::client {
namespace {

/// What the table on the terminal shows of a summary; --csv and --json have everything. Where there is no room the
/// highest ranks go first.
struct SummaryColumn {
  const char* title;
  const char* field;
  int rank;
};
constexpr SummaryColumn kColumns[] = {
    {"N", "n_rods", 3},
    {"S", "order.mean", 0},
    {"SEM", "order.sem", 1},
    {"STD", "order.std", 5},
    {"N_EFF", "order.n_effective", 4},
    {"THETA_M deg", "measured.theta_m_deg.value", 2},
    {"SEM deg", "measured.theta_m_deg.sem", 2},
    {"TAU s", "order.tau_s", 8},
    {"STEADY s", "order.t_steady_s", 6},
    {"SIM s", "sim_seconds", 6},
    {"CPU s", "cpu_seconds", 7},
    {"ROD-S/CPU-S", "rod_seconds_per_cpu_second", 9},
    {"OVERLAP mm", "max_overlap_mm", 10},
};
constexpr SummaryColumn kAggregateColumns[] = {
    {"REPLICAS", "n_replicas", 4},
    {"DONE", "n_done", 3},
    {"N", "n_rods", 3},
    {"S", "order.mean", 0},
    {"SEM", "order.sem", 1},
    {"STD", "order.std", 5},
    {"N_EFF", "order.n_effective", 4},
    {"THETA_M deg", "measured.theta_m_deg.value", 2},
    {"SEM deg", "measured.theta_m_deg.sem", 2},
    {"TAU s", "order.tau_s", 8},
    {"SIM s", "sim_seconds", 6},
    {"CPU s", "cpu_seconds", 7},
};

class Results : public Verb {
 public:
  VerbInfo info() const override {
    return {
        "results", kResultsGroup, "One line of numbers per job, or per point with --aggregate",
        "  shaken results                               the newest sweep\n"
        "  shaken results s3 --aggregate                replicas as mean and standard error\n"
        "  shaken results s3 --where 'rods.length=4.5mm and order.mean>0.5'\n"
        "  shaken results s3 --where 'not state=done or order.sem>0.01' --csv\n"
        "  shaken results s3 --columns job,order.mean,theta_m_deg\n"
        "  shaken results s3 --csv > order.csv          every field of every summary: the names for --columns\n"
        "Quote conditions, so that the shell does not interpret < > ( ). --where takes and, or, not, ( ), and = != < "
        "<= > "
        ">= with\n"
        "any key of the scene or number of the summary to their left: `--csv` shows their names. A comparison is "
        "false\n"
        "for runs that lack the name.\n"
        "A value marked ~ is of a run that is still relaxing, one marked ? of a run that is not known to be steady:\n"
        "run them longer. With --aggregate, (2) behind a mean says that only 2 runs have a "
        "value.",
        kExitCodesOfDaemon};
  }

  void declare(Arguments& arguments) override {
    arguments.optional("ID", id_, "A sweep (id or name) or a job; the newest sweep if left out", Names::kId);
    arguments.repeatable("-w,--where", where_, "CONDITION",
                         "Only rows that match, e.g. 'order.mean>0.5 and box.gap<2mm'; repeatable, all must hold");
    arguments.flag("-a,--aggregate", aggregate_, "Replicas of a point as mean and standard error");
    arguments.option("--columns", columns_, "FIELD,FIELD", "These fields only, as a table or with --csv",
                     Names::kAnything);
    arguments.flag("--csv", csv_, "All fields as CSV");
    arguments.flag("--json", json_, "The daemon's rows, or the aggregated ones, as JSON");
  }

  ExitCode run(const Context& context) override {
    if (csv_ && json_) throw Failure(ExitCode::kBadInput, "--csv and --json exclude each other");
    Conditions conditions = Conditions::parse(where_);
    ApiClient session(context.root());
    const Target target = find_target_or_newest(session, id_);
    std::vector<ResultRow> rows = result_rows(session, target);
    conditions.add_from_scenes(rows, target);
    Console& console = context.console;
    // Conditions are on the rows shown: with --aggregate on means.
    if (aggregate_) {
      if (has_several_versions(rows)) {
        console.err << "several versions computed these runs; each has means of its own (versions.shaken, "
                       "versions.physics)\n";
      }
      rows = aggregated(rows);
    }
    conditions.keep_matching(rows, aggregate_ ? "points" : "runs", console.err);

    if (json_) {
      Json list = Json::array();
      for (const ResultRow& row : rows) list.push_back(aggregate_ ? row.fields : row.source);
      console.out << json_text(Json{{"rows", list}});
    } else if (csv_) {
      console.out << to_csv(rows, chosen_fields(rows));
    } else {
      if (id_.empty()) console.err << target.title() << "\n";
      print_table(rows, console);
    }
    return ExitCode::kOk;
  }

 private:
  static bool any_value(const std::vector<ResultRow>& rows, const std::string& field) {
    return std::any_of(rows.begin(), rows.end(), [&](const ResultRow& row) {
      const auto value = row.fields.find(field);
      return value != row.fields.end() && !value->is_null();
    });
  }

  /// As --columns names them; none if it is not given. All that no row has are refused together.
  std::vector<std::string> chosen_fields(const std::vector<ResultRow>& rows) const {
    std::vector<std::string> fields;
    if (rows.empty()) return fields;
    std::string problems;
    for (std::size_t begin = 0; begin < columns_.size();) {
      const std::size_t end = std::min(columns_.find(',', begin), columns_.size());
      const std::string word = columns_.substr(begin, end - begin);
      begin = end + 1;
      if (word.empty()) continue;
      try {
        fields.push_back(resolved_field(rows, word));
      } catch (const Failure& failure) {
        problems += (problems.empty() ? "" : "\n") + std::string(failure.what());
      }
    }
    if (!problems.empty()) throw Failure(ExitCode::kBadInput, problems + "\n--csv shows all names");
    return fields;
  }

  void print_table(const std::vector<ResultRow>& rows, Console& console) const {
    if (rows.empty()) {
      console.out << "No rows.\n";
      return;
    }
    std::vector<Table::Column> columns;
    std::vector<std::string> fields;
    const bool is_chosen = !columns_.empty();
    const auto add_column = [&](const std::string& title, const std::string& field, int rank) {
      bool filled = false, numbers = true;
      for (const ResultRow& row : rows) {
        const auto value = row.fields.find(field);
        if (value == row.fields.end()) continue;
        filled = true;
        numbers &= value->is_number() || value->is_null();
      }
      if (!filled || (!is_chosen && rank > 0 && !any_value(rows, field))) return;
      columns.push_back({printable(title), numbers ? Table::Align::kRight : Table::Align::kLeft, rank});
      fields.push_back(field);
    };
    if (const std::vector<std::string> chosen = chosen_fields(rows); !chosen.empty()) {
      for (const std::string& field : chosen) add_column(field, field, 0);
    } else {
      add_default_columns(rows, add_column);
    }

    Table table(columns);
    std::set<Steadiness> met;
    for (const ResultRow& row : rows) {
      std::vector<std::string> cells;
      for (const std::string& field : fields) {
        const auto value = row.fields.find(field);
        const Steadiness of = steadiness(row, field);
        met.insert(of);
        if (field == "job") {
          cells.push_back(short_id(field_text(row, field)));
        } else if (value != row.fields.end() && value->is_number()) {
          std::string text = mark_of(of) + number_text(value->get<double>());
          if (row.fields.contains(field + ":n")) text += fmt::format(" ({})", field_text(row, field + ":n"));
          cells.push_back(of == Steadiness::kSteady ? text : console.painted(Colour::kYellow, text));
        } else {
          cells.push_back(field_text(row, field));
        }
      }
      table.add_row(std::move(cells));
    }
    console.out << table.text(console.width);
    for (const Steadiness of : {Steadiness::kRelaxing, Steadiness::kNotKnown}) {
      if (met.contains(of))
        console.out << console.painted(Colour::kYellow, mark_of(of)) << " " << meaning_of(of) << "\n";
    }
    std::string left_out;
    for (const std::string& title : table.left_out(console.width)) left_out += (left_out.empty() ? "" : ", ") + title;
    if (!left_out.empty()) {
      console.err << fmt::format("no room for {} (--columns FIELD,... chooses, --csv has all)\n", left_out);
    }
  }

  template <class AddColumn>
  void add_default_columns(const std::vector<ResultRow>& rows, const AddColumn& add_column) const {
    const auto any = [&rows](auto holds) { return std::any_of(rows.begin(), rows.end(), holds); };
    if (!aggregate_) {
      add_column("JOB", "job", 0);
      const bool all_done = !any([](const ResultRow& row) { return row.state != "done"; });
      add_column("STATE", "state", all_done ? 3 : 0);
    }
    for (const std::string& path : swept_parameters(rows)) add_column(path, path, 0);
    if (has_several_versions(rows)) {
      add_column("SHAKEN", "versions.shaken", 0);
      add_column("PHYSICS", "versions.physics", 0);
    }
    if (aggregate_) {
      for (const auto& [title, field, rank] : kAggregateColumns) add_column(title, field, rank);
      return;
    }
    if (any([](const ResultRow& row) { return row.number("replica") > 1; })) add_column("REPLICA", "replica", 1);
    for (const auto& [title, field, rank] : kColumns) add_column(title, field, rank);
  }

  std::string id_;
  std::vector<std::string> where_;
  std::string columns_;
  bool aggregate_ = false;
  bool csv_ = false;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_results() { return std::make_unique<Results>(); }

}  // namespace shaken::client
