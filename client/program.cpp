#include "client/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ios>
#include <utility>

#include "base/text.h"
#include "client/command_line.h"
#include "client/live/json.h"
#include "run/files/version.h"

namespace shaken::client {

ExitCode run_program(const std::vector<std::string>& arguments, Console& console, Verbs verbs) {
  ExitCode code = ExitCode::kOk;
  std::string message;
  try {
    CommandLine command_line(std::move(verbs));
    if (Verb* verb = command_line.parse(arguments, console)) {
      // the programs that it starts look there, too
      if (!command_line.root().empty()) setenv("SHAKEN_ROOT", command_line.root().c_str(), 1);
      const Context context{console, command_line.root(), command_line.app()};
      code = verb->run(context);
    }
  } catch (const Failure& failure) {
    code = failure.code;
    message = failure.what();
  } catch (const Json::exception& error) {
    code = ExitCode::kFailed;
    message =
        fmt::format("an answer of the daemon is not as expected ({}): is it of another version than this client ({})?",
                    error.what(), run::version());
  } catch (const std::exception& error) {
    code = ExitCode::kFailed;
    message = error.what();
  }
  const bool wants_json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
  if (!message.empty() && wants_json) {
    console.out << json_text(Json{{"error", message}, {"exit_code", static_cast<int>(code)}});
  }
  console.out.flush();
  message.erase(message.find_last_not_of('\n') + 1);  // lists of problems end each with one
  if (!message.empty()) console.err << "shaken: " << printable(message, Lines::kMany) << "\n";
  // The reader of a pipe has gone: say nothing, but do not claim success.
  if (!console.out.good() && code == ExitCode::kOk) code = ExitCode::kFailed;
  return code;
}

}  // namespace shaken::client
