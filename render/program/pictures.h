#pragma once

#include "render/program/options.h"

namespace shaken::render {

/// One frame of recorded runs, as a file. What goes wrong is a Failure.
void make_picture(const Options& options);

/// The present state of a running job, as a file.
void make_live_picture(const Options& options);

/// Prints a preset as a style file, or a list of them.
void print_styles(const Options& options);

}  // namespace shaken::render
