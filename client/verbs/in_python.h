// Verbs whose work the Python package does: here they have their help and their options, which it is handed on.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "client/verb.h"

namespace shaken::client {

/// A verb that goes on as a part of the package, with its options that have no variable here.
class InPython : public Verb {
 public:
  void declare(Arguments& arguments) final {
    declare_options(arguments);
    arguments.hand_on(words_);
  }

 protected:
  virtual void declare_options(Arguments& arguments) = 0;
  /// Goes on as `python3 -m shaken.PART FIRST WORDS`.
  ExitCode go_on(const Context& context, const std::string& part, const std::vector<std::string>& first) const;

 private:
  std::vector<std::string> words_;
};

/// One that has no more than its options, and goes on with `first` and the daemon's root.
std::unique_ptr<Verb> handed_on(const std::string& part, const std::vector<std::string>& first, const VerbInfo& info,
                                void (*declare_options)(Arguments& arguments));

/// The daemon's root, as --root of all of them.
std::string root_option(const Context& context);

}  // namespace shaken::client
