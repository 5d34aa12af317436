// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace shaken::bench {

using Row = std::vector<std::string>;

/// Rows of ASCII text, the first of them the titles, in columns flush right; one line each.
std::string aligned(const std::vector<Row>& rows);

}  // namespace shaken::bench
