// SPDX-License-Identifier: MIT
#include "web/read_run.h"

#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/files.h"
#include "run/files/content_hash.h"
#include "run/files/directory.h"
#include "web/packed_frame.h"
#include "web/recorded_run.h"

namespace shaken::web {
namespace {

using Json = nlohmann::ordered_json;

std::string line_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

/// A damaged file may make a reader ask for much memory, or end in a core dump: neither is to hurt the machine.
void be_expendable() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  [[maybe_unused]] const auto done = write_file("/proc/self/oom_score_adj", "1000");
}

Result<std::string> curves(const RecordedRun& run, std::span<const std::string> wanted) {
  const auto curves = run.curves();
  if (!curves) return curves.error();
  Json names = Json::array(), chosen = Json::object();
  for (const auto& [name, values] : *curves) {
    names.push_back({{"name", name}, {"points", values.size()}});
    if (std::find(wanted.begin(), wanted.end(), name) != wanted.end()) chosen[name] = values;  // NaN becomes null
  }
  return line_of({{"names", names}, {"curves", chosen}});
}

Result<std::string> answer(const RecordedRun& run, const std::vector<std::string>& question) {
  if (question.front() == "curves") return curves(run, std::span(question).subspan(1));
  if (question.front() == "frames") {
    const auto frames = run.frames();
    if (!frames) return frames.error();
    return line_of({{"n", frames->n}, {"first_s", frames->first}, {"last_s", frames->last}});
  }
  if (question.front() != "frame" || question.size() != 2) return Error{"there is no question " + question.front()};
  std::size_t index = 0;
  const std::string& number = question[1];
  if (std::from_chars(number.data(), number.data() + number.size(), index).ec != std::errc()) {
    return Error{number + " is no number of a frame"};
  }
  const auto frame = run.frame(index);
  if (!frame) return frame.error();
  return packed(*frame);
}

}  // namespace

int read_run_command(int argc, char** argv) {
  if (argc < 4) {
    std::fputs("shaken-web read DIR QUESTION... is asked by shaken-web itself\n", stdout);
    return 2;
  }
  be_expendable();
  Result<std::string> told = Error{""};
  try {
    const run::RunDirectory directory{argv[2]};
    run::assume_whole(directory.trajectory());
    run::assume_whole(directory.observables());
    told = answer(RecordedRun(directory.root), {argv + 3, argv + argc});
  } catch (const std::exception& problem) {  // no memory for what a damaged file asks for
    told = Error{problem.what()};
  }
  const std::string& text = told ? *told : told.error().message;
  const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  return told && is_written ? 0 : 1;
}

}  // namespace shaken::web
