#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "client/arguments.h"

namespace shaken::client {

struct Context;

/// What is drawn.
struct Drawn {
  std::string directory;
  std::string name;     ///< of files made of it, without an ending
  std::string id{};     ///< of the job; empty for a directory that the daemon is not asked about
  std::string state{};  ///< of the job
  std::string label{};  ///< what was swept; empty if nothing was
  std::string sweep{};  ///< of the job
};

/// The options that `shaken picture` and `shaken movie` have in common, and what they are about.
class PictureOptions {
 public:
  /// `films` of pictures: those that have a speed.
  void declare(Arguments& arguments, bool films);
  /// What was given, as shaken-render takes it; `labels` are the headlines, one for each run, where none was given.
  std::vector<std::string> words(const std::vector<std::string>& labels) const;
  /// Draws `drawn`, as `shaken-render WHAT` does with these options and those of `more` that have a value, into a file
  /// that is named after the first with `ending`, unless --out says where. Throws Failure.
  [[noreturn]] void draw(const Context& context, const std::string& what, const std::vector<Drawn>& drawn,
                         const std::vector<std::pair<std::string, std::string>>& more, const std::string& ending) const;

  std::vector<std::string> jobs;  ///< ids, or the beginnings of some, or run directories; several go side by side
  std::string out;

 private:
  std::map<std::string, std::string> values_;
  std::map<std::string, bool> switches_;
  std::string style_;
  std::vector<std::string> labels_;
  bool bare_ = false;
};

/// Finds them. Throws Failure.
std::vector<Drawn> find_drawn(const Context& context, const std::vector<std::string>& jobs);
/// The sweep of the first of them, with the place of each, as shaken-render takes it: S by the first two parameters
/// that differ. Throws Failure.
std::string sweep_of(const Context& context, const std::vector<Drawn>& drawn);
std::vector<std::string> labels_of(const std::vector<Drawn>& drawn);

}  // namespace shaken::client
