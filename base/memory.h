#pragma once

namespace shaken {

/// Keeps some memory for the moment in which the system has no more: the first request that it refuses is then granted
/// from this, once, in whatever thread. Without it a program that stays up for months ends by the first refusal in a
/// place that cannot fail, such as a destructor of JSON. To be called again and again, as it is gone once it was used.
void keep_memory_in_reserve();

/// Memory that this process has held when it held most, as resident pages [bytes]; 0 where the system does not tell.
double peak_memory();

/// The same of that child of this process, of those that have ended, which held most. A child begins as a copy of this
/// process, whose own memory may therefore be the larger part of it.
double children_peak_memory();

}  // namespace shaken
