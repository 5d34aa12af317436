#include "client/verbs/in_python.h"

#include <fmt/format.h>

#include <cstdlib>

#include "base/paths.h"
#include "base/plots_by_python.h"
#include "base/process.h"

namespace shaken::client {
namespace {

class HandedOn final : public InPython {
 public:
  HandedOn(std::string part, std::vector<std::string> first, const VerbInfo& info, void (*options)(Arguments&))
      : part_(std::move(part)), first_(std::move(first)), info_(info), declare_(options) {}

  VerbInfo info() const override { return info_; }
  void declare_options(Arguments& arguments) override { declare_(arguments); }
  ExitCode run(const Context& context) override {
    first_.push_back(root_option(context));
    return go_on(context, part_, first_);
  }

 private:
  std::string part_;
  std::vector<std::string> first_;
  VerbInfo info_;
  void (*declare_)(Arguments&);
};

}  // namespace

std::unique_ptr<Verb> handed_on(const std::string& part, const std::vector<std::string>& first, const VerbInfo& info,
                                void (*declare_options)(Arguments& arguments)) {
  return std::make_unique<HandedOn>(part, first, info, declare_options);
}

std::string root_option(const Context& context) { return "--root=" + context.root().string(); }

ExitCode InPython::go_on(const Context& context, const std::string& part, const std::vector<std::string>& first) const {
  std::vector<std::string> command = python_command(part);
  command.insert(command.end(), first.begin(), first.end());
  command.insert(command.end(), words_.begin(), words_.end());
  setenv("SHAKEN_PROGRAM", sibling_program("shaken").c_str(), 1);
  setenv("SHAKEN_CONFIGS", shipped_configs().c_str(), 1);
  try {
    return context.console.run_instead(context.console, command);
  } catch (const Failure& failure) {
    throw Failure(ExitCode::kBadInput, fmt::format("`shaken {}` is done by Python: {} (`apt install python3`, or set "
                                                   "SHAKEN_PYTHON)",
                                                   info().name, failure.what()));
  }
}

}  // namespace shaken::client
