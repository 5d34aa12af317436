// SPDX-License-Identifier: MIT
#pragma once

namespace shaken {

/// The first call of every program, named `program` in messages. Opens /dev/null on those of descriptors 0, 1 and 2
/// that are closed: the next file that is opened would otherwise take their place, and get what is meant for them. When
/// the program ends, checks that its standard output could be written: says so on stderr if not, and ends with
/// ExitCode::kFailed where it would have claimed success. The reader of a pipe that has gone is not worth a word.
/// A file beyond the limit of its user (`ulimit -f`) is an error of the call that writes it, and no signal.
void guard_standard_streams(const char* program);

}  // namespace shaken
