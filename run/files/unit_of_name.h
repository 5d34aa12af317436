#pragma once

#include <span>
#include <string>
#include <string_view>

namespace shaken::run {

/// The symbols that such names end in, each perhaps with a power: "mm", "s".
std::span<const std::string_view> unit_symbols();

/// The unit that the name of an array or number ends in, as H5MD writes units: "/velocity/c_v_mm2_s2" is in "mm2 s-2",
/// "q_per_mm" in "mm-1"; "1" if it ends in none. The first unit of a name stands above the line and all that follow it
/// below, as do all after "per".
std::string unit_of_name(std::string_view name);

/// What the standard error of an array is called: "/msd/total_sem_mm2" of "/msd/total_mm2".
std::string with_sem(std::string_view name);

}  // namespace shaken::run
