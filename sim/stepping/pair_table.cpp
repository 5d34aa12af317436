// SPDX-License-Identifier: MIT
#include "sim/stepping/pair_table.h"

#include "sim/core/heap_bytes.h"

namespace shaken {
namespace {

void count(std::vector<std::int16_t>& counts, const PairRods& rods, bool up) {
  for (const int i : rods) counts[i] = static_cast<std::int16_t>(counts[i] + (up ? 1 : -1));
}

}  // namespace

void PairTable::make_room(std::size_t n_pairs) {
  pairs_.resize(n_pairs);
  detected_at_.resize(n_pairs, -1);
  wheel_.make_room(n_pairs);
}

void PairTable::add(int p, const PairRods& rods, std::uint8_t owner) {
  pairs_[p].rods = rods;
  pairs_[p].direction = {};
  pairs_[p].line = {};
  pairs_[p].owner = owner;
  detected_at_[p] = -1;
}

void PairTable::remove(int p) {
  if (is_used(p) && is_touching(p)) turn_touching(p);  // it was at its last visit; by now it certainly is not
  pairs_[p].rods = kUnused;
  wheel_.remove(p);
}

void PairTable::turn_touching(int p) {
  pairs_[p].marks ^= kTouching;
  count(n_touching_, pairs_[p].rods, is_touching(p));
}

std::size_t PairTable::bytes() const { return wheel_.bytes() + heap_bytes(pairs_, detected_at_, n_touching_); }

}  // namespace shaken
