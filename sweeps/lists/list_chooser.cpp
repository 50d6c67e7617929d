// SPDX-License-Identifier: MIT
#include "sweeps/lists/list_chooser.h"

#include <algorithm>
#include <utility>

#include "base/numbers/parallel.h"

namespace wholehand::sweeps {
namespace {

constexpr std::size_t USUAL_POOL = 1 << 14;     // of a vessel: 256 KiB
constexpr std::size_t HANDS_AT_ONCE = 1 << 12;  // whose hands are there at once
constexpr std::size_t PIECE = 16;               // grips that a thread poses at a time
constexpr std::size_t FEW = 256;                // posed at a time where the first ones may be enough
constexpr std::size_t MOST_ASKED = 1 << 12;     // of others at a time

}  // namespace

std::size_t usual_pool(const Plan& plan, std::size_t best, double apart) {
  return apart == 0 ? std::max<std::size_t>(1, best) : std::max({std::size_t{1}, best, USUAL_POOL / plan.hand_scales()});
}

ListChooser::ListChooser(const Plan& plan, const Evaluator* core, std::size_t vessel, const ListRequest& request,
                         std::vector<ListProgress> progress)
    : plan_(plan),
      core_(core),
      vessel_(vessel),
      request_(request),
      progress_(std::move(progress)),
      taken_(plan.hand_scales(), DifferentGrips(request.best, request.apart)),
      pools_(plan.hand_scales(), BestCandidates(request.pool)) {
  progress_.resize(plan.hand_scales());
  for (std::size_t list = 0; list < progress_.size(); ++list) {
    if (request.best == 0) progress_[list].is_complete = true;
    if (progress_[list].is_complete) continue;
    const auto hands = hands_of(progress_[list].chosen);
    for (std::size_t i = 0; i < hands.size(); ++i) taken_[list].offer(progress_[list].chosen[i], hands[i]);
  }
}

ListChooser::Hands ListChooser::hands_of(const std::vector<Candidate>& grips) const {
  Hands hands(grips.size());
  if (request_.apart == 0) return hands;
  in_parallel((grips.size() + PIECE - 1) / PIECE, request_.threads, [&](std::size_t piece) {
    const std::size_t end = std::min(grips.size(), (piece + 1) * PIECE);
    for (std::size_t i = piece * PIECE; i < end; ++i) hands[i] = core_->posed(vessel_, plan_.grip(vessel_, grips[i].index));
  });
  return hands;
}

// Whether a list still wants to know of a grip.
bool ListChooser::is_open(std::size_t list, const Candidate& grip) const {
  const ListProgress& known = progress_[list];
  return !known.is_complete && (!known.decided || is_better(*known.decided, grip)) && pools_[list].takes(grip);
}

void ListChooser::offer(const std::vector<Candidate>& grips) {
  for (std::size_t first = 0; first < grips.size(); first += HANDS_AT_ONCE)
    offer_piece(grips.data() + first, std::min(HANDS_AT_ONCE, grips.size() - first));
}

void ListChooser::offer_piece(const Candidate* grips, std::size_t count) {
  std::vector<Candidate> to_pose;
  std::vector<std::size_t> lists;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t list = plan_.hand_scales() > 1 ? plan_.hand_scale_of(grips[i].index) : 0;
    if (!is_open(list, grips[i])) continue;
    if (progress_[list].chosen.empty()) {
      pools_[list].offer(grips[i]);
    } else {
      to_pose.push_back(grips[i]);
      lists.push_back(list);
    }
  }
  const auto hands = hands_of(to_pose);
  for (std::size_t i = 0; i < hands.size(); ++i)
    if (taken_[lists[i]].differs(hands[i])) pools_[lists[i]].offer(to_pose[i]);
}

std::vector<Candidate> ListChooser::open_grips() const {
  std::vector<Candidate> all;
  for (const BestCandidates& pool : pools_) {
    const std::vector<Candidate> grips = pool.sorted();
    all.insert(all.end(), grips.begin(), grips.end());
  }
  return all;
}

void ListChooser::add_open(const std::vector<Candidate>& grips) {
  for (const Candidate& grip : grips) {
    const std::size_t list = plan_.hand_scales() > 1 ? plan_.hand_scale_of(grip.index) : 0;
    if (is_open(list, grip)) pools_[list].offer(grip);
  }
}

void ListChooser::end_pass(const PoseHands& pose) {
  for (std::size_t list = 0; list < progress_.size(); ++list) {
    if (!progress_[list].is_complete) choose_from_pool(list, pose);
    pools_[list] = BestCandidates(request_.pool);
  }
}

void ListChooser::choose_from_pool(std::size_t list, const PoseHands& pose) {
  const std::vector<Candidate> pool = pools_[list].sorted();
  DifferentGrips& taken = taken_[list];
  std::size_t few = FEW;
  for (std::size_t first = 0; first < pool.size() && !taken.is_full();) {
    const std::size_t count = std::min(few, pool.size() - first);
    const auto start = pool.begin() + static_cast<std::ptrdiff_t>(first);
    const std::vector<Candidate> some(start, start + static_cast<std::ptrdiff_t>(count));
    const Hands hands = pose ? pose(some) : hands_of(some);
    for (std::size_t i = 0; i < count; ++i) taken.offer(some[i], hands[i]);
    first += count;
    if (pose) few = std::min(2 * few, MOST_ASKED);  // each question to others takes time
  }
  ListProgress& known = progress_[list];
  known.chosen = taken.chosen();
  // A pool that is not full had room for every grip that was open.
  known.is_complete = taken.is_full() || pool.size() < request_.pool;
  if (!known.is_complete) known.decided = pool.back();
}

bool ListChooser::is_complete() const {
  return std::all_of(progress_.begin(), progress_.end(), [](const ListProgress& list) { return list.is_complete; });
}

std::vector<Candidate> ListChooser::chosen() const {
  std::vector<Candidate> all;
  for (const ListProgress& list : progress_) all.insert(all.end(), list.chosen.begin(), list.chosen.end());
  return all;
}

}  // namespace wholehand::sweeps
