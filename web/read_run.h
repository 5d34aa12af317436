#pragma once

namespace shaken::web {

/// `shaken-web read DIR QUESTION...`: what one run directory holds, for web/run_reader.h. DIR is the run's; its files
/// are taken for whole. The question is one of
/// - `frames`: {"n", "first_s", "last_s"}
/// - `frame K`: the bytes of web/packed_frame.h
/// - `curves NAME...`: {"names", "curves"} of observables.h5, with the values of those that are named
/// The answer goes to stdout. Returns the exit code: 0, or 1 with the reason on stdout in place of the answer.
int read_run_command(int argc, char** argv);

}  // namespace shaken::web
