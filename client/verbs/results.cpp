// SPDX-License-Identifier: MIT
#include "client/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "client/print.h"
#include "client/result_rows.h"
#include "client/target.h"
#include "client/verbs/verbs.h"

namespace shaken::client {
namespace {

/// What the table on the terminal shows of a summary; --csv and --json have everything.
struct SummaryColumn {
  const char* title;
  const char* field;
};
constexpr SummaryColumn kColumns[] = {
    {"N", "n_rods"},
    {"S", "order.mean"},
    {"SEM", "order.sem"},
    {"STD", "order.std"},
    {"TAU s", "order.tau_s"},
    {"STEADY s", "order.t_steady_s"},
    {"SIM s", "sim_seconds"},
    {"CPU s", "cpu_seconds"},
    {"ROD-S/CPU-S", "rod_seconds_per_cpu_second"},
    {"OVERLAP mm", "max_overlap_mm"},
};
constexpr SummaryColumn kAggregateColumns[] = {
    {"REPLICAS", "n_replicas"}, {"DONE", "n_done"},        {"N", "n_rods"},
    {"S", "order.mean"},        {"SEM", "order.mean:sem"}, {"STD", "order.std"},
    {"TAU s", "order.tau_s"},   {"SIM s", "sim_seconds"},  {"CPU s", "cpu_seconds"},
};

class Results : public Verb {
 public:
  VerbInfo info() const override {
    return {"results", kResultsGroup, "One line of numbers per job, or per point with --aggregate",
            "  shaken results                               the newest sweep\n"
            "  shaken results s3 --aggregate                replicas as mean and standard error\n"
            "  shaken results s3 --where 'rods.area_fraction>0.6' --where 'order.mean>=0.5'\n"
            "  shaken results s3 --csv > order.csv          every field of every summary"};
  }

  void declare(Arguments& arguments) override {
    arguments.optional("ID", id_, "A sweep (id or name) or a job; the newest sweep if left out", Names::kId);
    arguments.repeatable("-w,--where", where_, "COMPARISON", "Only rows that match, e.g. 'order.mean>0.5'; repeatable");
    arguments.flag("-a,--aggregate", aggregate_, "Replicas of a point as mean and standard error");
    arguments.flag("--csv", csv_, "All fields as CSV");
    arguments.flag("--json", json_, "The daemon's rows, or the aggregated ones, as JSON");
  }

  ExitCode run(const Context& context) override {
    if (csv_ && json_) throw Failure(ExitCode::kBadInput, "--csv and --json exclude each other");
    std::vector<Condition> conditions;
    for (const std::string& text : where_) conditions.emplace_back(text);
    Session session(context.root);
    const Target target = find_target_or_newest(session, id_);
    std::vector<ResultRow> rows = result_rows(session, target);
    // Conditions are on the rows shown: with --aggregate on means.
    if (aggregate_) rows = aggregated(rows);
    rows = filtered(rows, conditions);

    Console& console = context.console;
    if (json_) {
      Json list = Json::array();
      for (const ResultRow& row : rows) list.push_back(aggregate_ ? row.fields : row.source);
      console.out << Json{{"rows", list}}.dump(2) << "\n";
    } else if (csv_) {
      console.out << to_csv(rows);
    } else {
      if (id_.empty()) console.err << target.title() << "\n";
      print_table(rows, console);
    }
    return ExitCode::kOk;
  }

 private:
  void print_table(const std::vector<ResultRow>& rows, Console& console) const {
    if (rows.empty()) {
      console.out << "No rows.\n";
      return;
    }
    std::vector<Table::Column> columns;
    std::vector<std::string> fields;
    const auto add_column = [&](const std::string& title, const std::string& field, Table::Align align) {
      const bool filled =
          std::any_of(rows.begin(), rows.end(), [&](const ResultRow& r) { return r.fields.contains(field); });
      if (!filled) return;
      columns.push_back({title, align});
      fields.push_back(field);
    };
    if (!aggregate_) {
      add_column("JOB", "job", Table::Align::kLeft);
      add_column("STATE", "state", Table::Align::kLeft);
    }
    for (const std::string& path : swept_parameters(rows)) add_column(path, path, Table::Align::kRight);
    if (aggregate_) {
      for (const auto& column : kAggregateColumns) add_column(column.title, column.field, Table::Align::kRight);
    } else {
      const bool has_replicas =
          std::any_of(rows.begin(), rows.end(), [](const ResultRow& r) { return r.number("replica") > 0; });
      if (has_replicas) add_column("REPLICA", "replica", Table::Align::kRight);
      for (const auto& column : kColumns) add_column(column.title, column.field, Table::Align::kRight);
    }

    Table table(columns);
    for (const ResultRow& row : rows) {
      std::vector<std::string> cells;
      for (const std::string& field : fields) {
        const auto value = row.fields.find(field);
        if (field == "job") {
          cells.push_back(short_id(field_text(row, field)));
        } else if (value != row.fields.end() && value->is_number()) {
          cells.push_back(number_text(value->get<double>()));
        } else {
          cells.push_back(field_text(row, field));
        }
      }
      table.add_row(std::move(cells));
    }
    console.out << table.text(console.width);
  }

  std::string id_;
  std::vector<std::string> where_;
  bool aggregate_ = false;
  bool csv_ = false;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Verb> make_results() { return std::make_unique<Results>(); }

}  // namespace shaken::client
