#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace shaken {

/// The processor of this machine as it calls itself, "Intel(R) Xeon(R) CPU @ 2.20GHz"; "unknown CPU" where it does not.
std::string cpu_name();

/// The cores that this process may use, at least 1: of those that the scheduler gives it (`taskset`, a batch system) as
/// many as the quotas of its group (cgroup) and of those around it are worth, rounded up.
int allowed_cores();
/// The cores that a quota is worth, as cpu.max has it ("150000 100000": 1.5); none if it says "max" or no number.
std::optional<double> cores_of_quota(std::string_view text);

}  // namespace shaken
