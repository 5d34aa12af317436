#pragma once

namespace shaken::scene {

/// from (to / from)^share, with the same bits on every machine; both ends positive, `share` in [0, 1].
double between_on_log_scale(double from, double to, double share);

}  // namespace shaken::scene
