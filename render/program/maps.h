// SPDX-License-Identifier: MIT
#pragma once

#include "render/program/options.h"

namespace shaken::render {

/// The last frames of the runs of a sweep over one or two parameters, in one picture. What goes wrong is a Failure.
void make_map(const Options& options);

}  // namespace shaken::render
