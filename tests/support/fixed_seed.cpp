#include <cstdlib>

namespace {

/// Property tests draw the same cases everywhere; RC_PARAMS in the environment still wins, to search for new ones.
[[maybe_unused]] const int kSeedIsFixed = setenv("RC_PARAMS", "seed=20240811", 0);

}  // namespace
