#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "sim/schedule/pair_search.h"
#include "sim/stepping/rod_states.h"
#include "sim/stepping/share.h"

namespace shaken {

/// Phase 2 of a tick: finds the contacts of all pairs that may get an impulse. Keeps references.
///
/// Beads that overlap but recede are left alone for a while. An impulse on one of the rods can make them approach
/// within the very tick, though, so wherever a rod may be hit, its touching pairs take part in that tick's response.
class DetectionPhase {
 public:
  DetectionPhase(const PairSearch& search, const NeighborList& neighbors, PairSchedule& pairs, RodStates& rods,
                 std::vector<Share>& shares)
      : search_(search), neighbors_(neighbors), pairs_(pairs), rods_(rods), shares_(shares) {}

  /// Searches the share's pairs that are due, and those touching ones of its rods that surfaces hit.
  void search_due(const World& world, Tick now, Share& share) {
    list_due(now, share);
    list_touching(now, share);
    pose_rods(world, now, share);
    for (const int p : share.searched) {
      const auto& [i, j] = pairs_.rods(p);
      // its owner may be posing it right now
      const bool is_other = rods_.owners[j] != share.number;
      if (is_other) share.other_pose = rod_at_tick(world.rods[j], now, rods_.rules).pose;
      const bool touching = find(p, is_other ? share.other_pose : rods_.flight_pose(j), share, share.contacts);
      if (touching != pairs_.is_touching(p)) share.toggled.push_back(p);
      share.counts.count(WorkKind::kPairsTouching, touching ? 1 : 0);
    }
    share.counts.count(WorkKind::kPairsSearched, std::ssize(share.searched));
  }

  /// Brings together what the shares have found.
  void gather(const World& world, Tick now) {
    contacts_.clear();
    for (Share& share : shares_) {
      contacts_.insert(contacts_.end(), share.contacts.begin(), share.contacts.end());
      share.contacts.clear();
      for (const int p : share.toggled) pairs_.toggle_touching(p);
      share.toggled.clear();
    }
    for (const PairContact& contact : contacts_) rods_.pose_if_needed(contact.j, world, now);
  }

  /// Searches pairs that have not been searched in this tick.
  void search_gained(std::span<const int> pairs, const World& world, Tick now) {
    for (const int p : pairs) {
      if (pairs_.is_used(p) && pairs_.searched_at(p) != now) search(p, world, now);
    }
  }

  /// Searches the touching pairs of all rods that may be hit in this tick. Then the contacts are complete; sorts them.
  void search_touching(const World& world, Tick now) {
    may_change_.clear();
    const auto note = [&](int i) {
      if (std::exchange(rods_.marks[i].touching_searched_at, now) != now) may_change_.push_back(i);
    };
    for (const Share& share : shares_) {
      for (const int i : share.hit) note(i);
    }
    std::size_t n_seen = 0;
    const auto note_contacts = [&] {
      for (; n_seen < contacts_.size(); ++n_seen) {
        for (const int i : {contacts_[n_seen].i, contacts_[n_seen].j}) {
          if (pairs_.n_touching(i) > 1) note(i);  // in more than this pair
        }
      }
    };
    note_contacts();
    for (std::size_t m = 0; m < may_change_.size(); ++m) {
      for (const int p : neighbors_.pairs_of(may_change_[m])) {
        if (!pairs_.is_touching(p) || pairs_.searched_at(p) == now) continue;
        shares_[pairs_.owner(p)].searched.push_back(p);
        search(p, world, now);
      }
      note_contacts();
    }
    sort_contacts(contacts_, rods_.at_tick, rods_.rules);
  }

  const std::vector<PairContact>& contacts() const { return contacts_; }

  std::size_t bytes() const { return heap_bytes(contacts_, may_change_); }

 private:
  /// Lists the pairs that come up and may touch, behind those that the first tick has gained.
  void list_due(Tick now, Share& share) {
    std::vector<int>& pairs = share.searched;
    const std::ptrdiff_t n_gained = std::ssize(pairs);
    pairs_.wheel().pop(now, pairs, static_cast<int>(share.number));
    const auto up = pairs.begin() + n_gained;
    for (auto p = up; p != pairs.end(); ++p) pairs_.prefetch(*p);
    for (auto p = up; p != pairs.end(); ++p) pairs_.prefetch_bound(*p);
    share.apart.clear();
    const auto cannot_touch = [&](int p) {
      const bool is_apart = pairs_.is_apart(p, now);
      if (is_apart) share.apart.push_back(p);
      return is_apart;
    };
    pairs.erase(std::remove_if(up, pairs.end(), cannot_touch), pairs.end());
    share.counts.count(WorkKind::kPairsApart, std::ssize(share.apart));
    for (const int p : pairs) {
      pairs_.set_searched(p, now);
      for (const int i : pairs_.rods(p)) prefetch(rods_.marks[i]);
    }
  }

  /// Lists the touching pairs of rods that surfaces hit, as far as they are the share's own: most are, and
  /// search_touching, on one thread, has less to do.
  void list_touching(Tick now, Share& share) {
    for (const int i : share.hit) {
      int n_unseen = pairs_.n_touching(i);
      for (const int p : neighbors_.pairs_of(i)) {
        if (n_unseen == 0) break;
        if (static_cast<std::size_t>(pairs_.owner(p)) != share.number || !pairs_.is_touching(p)) continue;
        --n_unseen;
        if (pairs_.searched_at(p) == now) continue;
        pairs_.set_searched(p, now);
        share.searched.push_back(p);
      }
      if (n_unseen == 0) rods_.marks[i].touching_searched_at = now;
    }
  }

  void pose_rods(const World& world, Tick now, Share& share) {
    share.to_pose.clear();
    for (const int p : share.searched) {
      for (const int i : pairs_.rods(p)) {
        if (rods_.owners[i] == share.number && rods_.claim_pose(i, now)) share.to_pose.push_back(i);
      }
    }
    rods_.pose_all(share.to_pose, world, now);
  }

  /// Searches one pair, on the first thread.
  void search(int p, const World& world, Tick now) {
    pairs_.set_searched(p, now);
    for (const int i : pairs_.rods(p)) rods_.pose_if_needed(i, world, now);
    const bool touching = find(p, rods_.flight_pose(pairs_.rods(p)[1]), shares_.front(), contacts_);
    if (touching != pairs_.is_touching(p)) pairs_.toggle_touching(p);
    shares_.front().counts.count(WorkKind::kPairsSearched);
    shares_.front().counts.count(WorkKind::kPairsTouching, touching ? 1 : 0);
  }

  bool find(int p, const Pose& pose_j, Share& share, std::vector<PairContact>& contacts) const {
    const PairRods& rods = pairs_.rods(p);
    return search_.find(rods, rods_.flight_pose(rods[0]), pose_j, pairs_.direction(p), share.beads, contacts);
  }

  const PairSearch& search_;
  const NeighborList& neighbors_;
  PairSchedule& pairs_;
  RodStates& rods_;
  std::vector<Share>& shares_;
  std::vector<PairContact> contacts_;
  std::vector<int> may_change_;  ///< rods that touch another and may yet be hit in this tick, each once
};

}  // namespace shaken
