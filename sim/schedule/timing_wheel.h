#pragma once

#include <cstdint>
#include <vector>

#include "base/core/heap_bytes.h"
#include "base/core/types.h"
#include "sim/lanes/prefetch.h"

namespace shaken {

/// Things to look at, by the tick at which they are due: a ring of slots, one per tick, each a doubly linked list
/// through the items themselves, so that an item is put in, put off and taken out in O(1) (Varghese & Lauck 1987).
/// Each owner has a ring of its own. Owners may put in, put off and take out items of theirs at the same time.
class TimingWheel {
 public:
  /// Due ticks may lie up to `horizon()` ahead.
  static constexpr Tick kSlots = 4096;
  static constexpr Tick horizon() { return kSlots - 1; }

  explicit TimingWheel(std::size_t n_items = 0, int n_owners = 1)
      : first_(static_cast<std::size_t>(kSlots) * static_cast<std::size_t>(n_owners), kNone), links_(n_items) {}

  /// Has `item` come up at tick `due`, and at no other. As long as it is in, it belongs to `owner`.
  void set(std::int32_t item, Tick due, int owner = 0) {
    Link& link = links_[item];
    const std::int32_t slot = slot_of(due, owner);
    if (link.slot == slot) return;
    if (link.slot != kNone) take_out(link);
    link.slot = slot;
    link.previous = kNone;
    link.next = first_[slot];
    if (link.next != kNone) links_[link.next].previous = item;
    first_[slot] = item;
  }

  /// When `item` comes up, seen from tick `now` (not before it); `now` if it is not in.
  Tick due(std::int32_t item, Tick now) const {
    const std::int32_t slot = links_[item].slot;
    if (slot == kNone) return now;
    return now + (slot - now % kSlots + kSlots) % kSlots;
  }

  /// Takes `item` out, if it is in.
  void remove(std::int32_t item) {
    Link& link = links_[item];
    if (link.slot != kNone) take_out(link);
    link.slot = kNone;
  }

  /// Items are numbered below `n_items` from now on; it never shrinks.
  void make_room(std::size_t n_items) {
    if (n_items > links_.size()) links_.resize(n_items);
  }

  /// Takes the owner's items of tick `now` out and appends them to `items`.
  void pop(Tick now, std::vector<std::int32_t>& items, int owner = 0) {
    std::int32_t& first = first_[slot_of(now, owner)];
    for (std::int32_t item = first; item != kNone; item = links_[item].next) {
      links_[item].slot = kNone;
      items.push_back(item);
    }
    first = kNone;
  }

  /// Asks for what `set` and `due` need of an item that will soon be put off.
  void prefetch(std::int32_t item) const { shaken::prefetch(links_[item]); }
  std::size_t bytes() const { return heap_bytes(first_, links_); }

 private:
  static constexpr std::int32_t kNone = -1;
  struct Link {
    std::int32_t slot = kNone;
    std::int32_t previous = kNone;
    std::int32_t next = kNone;
  };

  static std::int32_t slot_of(Tick tick, int owner) {
    return static_cast<std::int32_t>(tick % kSlots) + owner * static_cast<std::int32_t>(kSlots);
  }
  void take_out(const Link& link) {
    (link.previous != kNone ? links_[link.previous].next : first_[link.slot]) = link.next;
    if (link.next != kNone) links_[link.next].previous = link.previous;
  }

  std::vector<std::int32_t> first_;  ///< (n_owners x kSlots) an item of each slot
  std::vector<Link> links_;          ///< (n_items)
};

}  // namespace shaken
