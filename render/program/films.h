#pragma once

#include "render/program/options.h"

namespace shaken::render {

/// Recorded runs as a film. What goes wrong is a Failure; SIGINT and SIGTERM stop it, and then no file is left.
void make_film(const Options& options);

}  // namespace shaken::render
