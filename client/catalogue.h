#pragma once

#include <string>

namespace shaken::client {

/// All that has a name, as JSON with a line for each thing: units, keys of scenes, of styles and of summary.json,
/// observables with their arrays and numbers, effects, states of jobs. Other programs read it
/// (python/shaken/catalogue.json), so that they have no list of their own.
std::string catalogue();

}  // namespace shaken::client
