// The standard streams of every program: that they are there, and what is said when they take nothing.
#pragma once

#include <string_view>

#include "base/core/result.h"

namespace shaken {

/// The first call of every program, named `program` in messages. Opens /dev/null on those of descriptors 0, 1 and 2
/// that are closed: the next file that is opened would otherwise take their place, and get what is meant for them. When
/// the program ends, checks that its standard output could be written: says so on stderr if not, and ends with
/// ExitCode::kFailed where it would have claimed success. The reader of a pipe that has gone is not worth a word.
/// A file beyond the limit of its user (`ulimit -f`) is an error of the call that writes it, and no signal.
void guard_standard_streams(const char* program);

/// `line` on stderr. That it cannot be written there changes nothing: there is nobody left to be told. (fmt::print
/// throws then, which ends a program by SIGABRT where it is told why it fails.)
void complain(std::string_view line);

/// Brings to its destination what has been printed on stdout by way of stdio or std::cout, or the reason why it cannot.
Result<void> flush_standard_output();

}  // namespace shaken
