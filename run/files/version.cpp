#include "run/files/version.h"

namespace shaken::run {

const char* version() { return SHAKEN_VERSION; }
const char* compiler() { return SHAKEN_COMPILER; }

}  // namespace shaken::run
