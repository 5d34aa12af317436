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
  rods_.resize(n_pairs, kUnused);
  directions_.resize(n_pairs);
  detected_at_.resize(n_pairs, -1);
  marks_.resize(n_pairs);
  owners_.resize(n_pairs);
  wheel_.make_room(n_pairs);
}

void PairTable::add(int p, const PairRods& rods, std::uint8_t owner) {
  rods_[p] = rods;
  owners_[p] = owner;
  directions_[p] = {};
}

void PairTable::remove(int p) {
  if (is_used(p)) {
    set_unperturbed(p, false);
    if (is_touching(p)) turn_touching(p);  // it was at its last visit; by now it certainly is not
  }
  rods_[p] = kUnused;
  wheel_.remove(p);
}

void PairTable::turn_touching(int p) {
  marks_[p] ^= kTouching;
  count(n_touching_, rods_[p], is_touching(p));
}

void PairTable::set_unperturbed(int p, bool unperturbed) {
  if (is_unperturbed(p) == unperturbed) return;
  marks_[p] ^= kUnperturbed;
  count(n_unperturbed_, rods_[p], unperturbed);
}

std::size_t PairTable::bytes() const {
  return wheel_.bytes() + heap_bytes(rods_, directions_, detected_at_, marks_, owners_, n_touching_, n_unperturbed_);
}

}  // namespace shaken
