#include "server/slurm/batch.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "base/files.h"

namespace shaken::server::slurm {
namespace {

using Json = nlohmann::ordered_json;

/// What `read` makes of a file of JSON.
template <class T, class Read>
Result<T> from_json(const std::filesystem::path& file, Read read) {
  const std::string text = SHAKEN_TRY(read_file(file));
  try {
    return read(Json::parse(text));
  } catch (const Json::exception& problem) {
    return Error{file.string() + ": " + problem.what()};
  }
}

std::string to_text(const Json& json) { return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"; }

}  // namespace

Result<void> write_batch(const BatchFolder& folder, const Batch& batch) {
  Json tasks = Json::array();
  for (const std::vector<Launch>& task : batch.tasks) {
    Json launches = Json::array();
    for (const Launch& launch : task) {
      launches.push_back(
          {{"directory", launch.directory.string()}, {"arguments", launch.arguments}, {"heading", launch.heading}});
    }
    tasks.push_back(std::move(launches));
  }
  return write_file_atomically(folder.plan(),
                               to_text({{"worker", batch.worker.string()}, {"tasks", std::move(tasks)}}));
}

Result<Batch> read_batch(const BatchFolder& folder) {
  return from_json<Batch>(folder.plan(), [](const Json& json) {
    Batch batch{json.at("worker").get<std::string>(), {}};
    for (const Json& launches : json.at("tasks")) {
      std::vector<Launch>& task = batch.tasks.emplace_back();
      for (const Json& launch : launches) {
        task.push_back({launch.at("directory").get<std::string>(),
                        launch.at("arguments").get<std::vector<std::string>>(),
                        launch.at("heading").get<std::string>()});
      }
    }
    return batch;
  });
}

Result<void> write_report(const std::filesystem::path& file, const TaskReport& report) {
  Json ends = Json::array();
  for (const auto& [place, end] : report.ends) {
    ends.push_back({{"place", place}, {"exit_code", end.exit_code}, {"signal", end.signal}, {"pid", end.pid}});
  }
  return write_file_atomically(file, to_text({{"slurm_job", report.slurm_job},
                                              {"host", report.host},
                                              {"restarts", report.restarts},
                                              {"begun", report.begun},
                                              {"ends", std::move(ends)}}));
}

Result<TaskReport> read_report(const std::filesystem::path& file) {
  return from_json<TaskReport>(file, [](const Json& json) {
    TaskReport report;
    report.slurm_job = json.at("slurm_job").get<std::string>();
    report.host = json.at("host").get<std::string>();
    report.restarts = json.at("restarts").get<int>();
    report.begun = json.at("begun").get<std::set<int>>();
    for (const Json& end : json.at("ends")) {
      report.ends[end.at("place").get<int>()] = {end.at("exit_code").get<int>(), end.at("signal").get<int>(),
                                                 end.at("pid").get<int>()};
    }
    return report;
  });
}

Result<void> write_stop(const std::filesystem::path& file, const std::set<int>& places, Lasting lasting) {
  std::string text;
  for (const int place : places) text += std::to_string(place) + "\n";
  return write_file_atomically(file, text, lasting);
}

std::set<int> read_stop(const std::filesystem::path& file) {
  std::set<int> places;
  if (const Result<std::string> text = read_file(file)) {
    std::istringstream words(*text);
    for (int place = 0; words >> place;) places.insert(place);
  }
  return places;
}

}  // namespace shaken::server::slurm
