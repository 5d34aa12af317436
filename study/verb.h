// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "client/verb.h"

namespace shaken::study {

/// `shaken figures`
std::unique_ptr<client::Verb> make_figures();

/// Every verb of the program `shaken`, the client's and this one, in the order of the help.
std::vector<std::unique_ptr<client::Verb>> make_all_verbs();

}  // namespace shaken::study
