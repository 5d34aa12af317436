#include "client/verbs/verbs.h"

namespace shaken::client {

Verbs make_verbs() {
  Verbs verbs;
#define SHAKEN_VERB(name) verbs.push_back(make_##name());
  SHAKEN_VERBS(SHAKEN_VERB)
#undef SHAKEN_VERB
  return verbs;
}

}  // namespace shaken::client
