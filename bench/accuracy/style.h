// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

namespace shaken::bench {

/// Of series k: Paul Tol's bright scheme, told apart by colour-blind readers too.
const char* colour(std::size_t k);

/// The gnuplot lines that begin a picture of so many panels, up to two rows of them, with both axes logarithmic.
std::string multiplot(const std::string& name, std::size_t panels);

}  // namespace shaken::bench
