#pragma once

namespace shaken {

/// Memory that this process has held when it held most, as resident pages [bytes]; 0 where the system does not tell.
double peak_memory();

/// The same of that child of this process, of those that have ended, which held most. A child begins as a copy of this
/// process, whose own memory may therefore be the larger part of it.
double children_peak_memory();

}  // namespace shaken
