// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "client/arguments.h"

namespace shaken::client {

struct Context;

/// An option of pictures and films: a key of shaken-render's styles.
struct PictureOption {
  const char* name;   ///< without the dashes
  const char* value;  ///< its name in the help; null for a switch, which is also --no-NAME
  const char* help;
};
/// All of them; shaken-render, to which they are handed on, checks what they are given.
std::span<const PictureOption> picture_options();

/// The options that `shaken picture` and `shaken movie` have in common, and what they are about.
class PictureOptions {
 public:
  void declare(Arguments& arguments);
  /// What was given, as shaken-render takes it; `label` is the headline where none was given.
  std::vector<std::string> words(const std::string& label) const;

  std::string job;  ///< a job's id, or the beginning of one, or a run directory
  std::string out;

 private:
  std::map<std::string, std::string> values_;
  std::map<std::string, bool> switches_;
  std::string style_, label_;
  bool bare_ = false;
};

/// What is drawn.
struct Drawn {
  std::string directory;
  std::string name;     ///< of files made of it, without an ending
  std::string id{};     ///< of the job; empty for a directory that the daemon is not asked about
  std::string state{};  ///< of the job
  std::string label{};  ///< what was swept; empty if nothing was
};

/// Finds it. Throws Failure.
Drawn find_drawn(const Context& context, const std::string& job);

}  // namespace shaken::client
