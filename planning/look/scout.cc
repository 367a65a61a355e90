// SPDX-License-Identifier: BSD-3-Clause
// The rule of docs/liveness.md. The potential is asked for the place of now and for that of some seconds ago, in the map
// of now: so neither an obstacle that was found meanwhile nor a pad that drove on counts as a step back.
#include "touchdown/planning/look/scout.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planning/certify/pad_strip.h"
#include "planning/look/lookout.h"
#include "planning/replan/plan_end.h"
#include "planning/replan/replan_checks.h"
#include "planning/replan/spaces.h"

namespace touchdown::planning {
namespace {

constexpr double kPatience = 2.5;   // without progress [s] ...
constexpr int kImages = 6;          // ... in which so many images were used
constexpr double kNearer = 0.3;     // is progress [m]
constexpr double kAsksEvery = 0.5;  // [s]
constexpr double kAtGoal = 0.3;     // [m]

constexpr double kDetour = 15.0;  // flown without a new best: then over it [m]
constexpr double kHigher = 0.5;   // is a climb [m]
constexpr double kOnwards = 1.0;  // is worth to be followed before cells are looked for [m]
constexpr double kFollows = 4.0;  // seen of a path that leaves the window [m]
constexpr double kPassesBy = 4.0;  // the places of that path: they are not stops [m]
constexpr std::size_t kUsualSteps = 1000, kUsualStruck = 500;

constexpr int kTurnsAround = 4;                  // on the spot, to see all around
constexpr double kNear = 0.3, kTurnedTo = 0.2;   // of a viewpoint [m], [rad] ...
constexpr double kSlow = 0.3;                    // ... where it hardly leans any more [m/s]
constexpr double kTries = 0.6, kStill = 0.15;    // a part of the way [s], [m/s] ...
constexpr double kShortest = 0.1;                // ... of so much [m]
constexpr int kLooks = 3;                        // images that are used there
constexpr double kEnough = 0.05;                 // of its cells may stay unseen
constexpr double kSlowest = 0.4, kLonger = 5.0;  // on the way there [m/s], and more [s]

}  // namespace

class Scout::Impl {
 public:
  explicit Impl(const ReplannerOptions& options)
      : options_(options), lookout_({options.vertical_cost, options.constants.tight_cost}) {
    was_.reserve(kUsualSteps);
    struck_.reserve(kUsualStruck);
  }

  void Prepare(const OccupancyMap& map) { lookout_.Prepare(SpaceFor(options_, map)); }

  const std::optional<NoWay>& no_way() const { return no_way_; }
  std::string_view look_words() const { return words_; }

  std::optional<Viewpoint> Step(const ReplanInput& input, const std::vector<LookCamera>& cameras,
                                const OccupancyMap& map, bool may_look) {
    if (cameras.empty() || WrongInState(input) || WrongInTarget(input, options_.max_duration)) {
      return std::nullopt;
    }
    Was now = {input.t_now, 0, input.vehicle.p_WB, Goal(input, map), input.vehicle.v_WB.norm()};
    for (const LookCamera& camera : cameras) now.images += camera.images;
    Note(now);
    if (AtGoal()) best_ = std::numeric_limits<double>::infinity();
    if (AtGoal() || !may_look) {
      detour_ = 0.0;
      NoteOpen();
    }
    if (!may_look) way_ = Way::kPlanned;
    if (look_ && !(may_look ? StillLooks(input, cameras, map)
                            : Ends("ends: what is flown now comes first"))) {
      Forget();
      was_.push_back(now);
    }
    if (look_) return Aim();
    const bool asks = way_ != Way::kPlanned || IsLongAgo(was_.front(), now, false);
    if (!may_look || !asks || now.t < asked_t_ + kAsksEvery) return std::nullopt;
    asked_t_ = now.t;
    Search(input, cameras, map);
    if (look_ == nullptr) return std::nullopt;
    ++looks_;
    words_ = reason_;
    images_there_.reset();
    reached_ = 0;
    AimAt(look_->way_W.size() - 1);
    return Aim();
  }

 private:
  struct Was {
    double t;
    int images;  // used until then
    Eigen::Vector3d p_WB, goal_W;
    double speed;
  };

  // The way that it goes.
  enum class Way {
    kPlanned,  // of the planner, or to see what it needs
    kOut,      // the one that leads out of the window
    kUp        // over what is in the way
  };

  void Note(const Was& now) {
    if (!was_.empty() && now.t > was_.back().t + kPatience) {  // what was before does not count
      if (look_) Ends("ends: there were no steps");
      way_ = Way::kPlanned;
      Forget();
    }
    if (was_.empty()) counted_W_ = now.p_WB;
    const double moved = (now.p_WB - counted_W_).norm();
    if (moved >= kNearer) {  // less may be noise
      detour_ += moved;
      counted_W_ = now.p_WB;
    }
    if (was_.size() == kUsualSteps) was_.erase(was_.begin() + 1);  // without images for long
    was_.push_back(now);
    ForgetLongAgo(now, look_ != nullptr);
  }

  void Forget() {
    look_ = nullptr;
    was_.clear();
  }

  static bool IsLongAgo(const Was& was, const Was& now, bool whatever_images) {
    return was.t <= now.t - kPatience && (whatever_images || was.images <= now.images - kImages);
  }

  bool IsStill() const { return was_.back().speed < kStill; }
  bool AtGoal() const { return (was_.back().goal_W - was_.back().p_WB).norm() < kAtGoal; }

  /// For as long as a question takes.
  bool Stays() const {
    const Was& now = was_.back();
    return IsLongAgo(was_.front(), now, true) &&
           std::all_of(was_.begin(), was_.end(),
                       [&](const Was& was) { return (was.p_WB - now.p_WB).norm() < kNearer; });
  }
  bool Stands() const { return IsStill() && Stays(); }

  /// But for the last that is.
  void ForgetLongAgo(const Was& now, bool whatever_images) {
    auto last = was_.begin();
    while (last + 1 != was_.end() && IsLongAgo(*(last + 1), now, whatever_images)) ++last;
    was_.erase(was_.begin(), last);
  }

  /// From now on to this place on the way of the look.
  void AimAt(std::size_t place) {
    aim_ = place;
    leg_ = (Aim().p_WB - was_.back().p_WB).norm();
    was_.erase(was_.begin(), was_.end() - 1);
    until_ = was_.back().t + look_->way / kSlowest + kLonger;
  }
  /// No plan leads there: to the farthest place before it to which a straight way leads. Where one leads to it, that was
  /// tried: at most half as far. False: there is none.
  bool AimsNearer(const ReplanInput& input, const OccupancyMap& map) {
    const FreeSpace space = SpaceOf(input, map);
    const HullSpace hull = HullFor(options_, space, input.margins.Sum(), DeckOf(input));
    const Eigen::Vector3d& here = was_.back().p_WB;
    const auto from_here = [&](std::size_t place) { return (look_->way_W[place] - here).norm(); };
    for (std::size_t place = reached_; place < aim_; ++place) {
      if (from_here(place) < from_here(reached_)) reached_ = place;
    }
    const bool tried = lookout_.Leads(hull, here, Aim().p_WB);
    const double most = tried ? 0.5 * leg_ : std::numeric_limits<double>::infinity();
    for (std::size_t place = aim_; place > reached_ + 1;) {
      --place;
      const double leg = from_here(place);
      if (leg < kShortest || leg > most || !lookout_.Leads(hull, here, look_->way_W[place]))
        continue;
      AimAt(place);
      return true;
    }
    return false;
  }
  bool InPart() const { return aim_ + 1 < look_->way_W.size(); }
  Viewpoint Aim() const { return {look_->way_W[aim_], look_->from.yaw}; }

  FreeSpace SpaceOf(const ReplanInput& input, const OccupancyMap& map) const {
    FreeSpace space = SpaceFor(options_, map);
    LayPadStrip(*input.pad, input.endpoint, was_.back().p_WB, input.t_start,
                input.t_start + options_.min_duration, options_.pad_radius, options_.contact_height,
                &space);
    return space;
  }

  /// Where the vehicle wants to be in the end: a descent that pauses wants to go on.
  Eigen::Vector3d Goal(const ReplanInput& input, const OccupancyMap& map) const {
    EndpointTarget end = input.endpoint;
    const double t = input.t_start + options_.min_duration;
    if (end.may_touch(options_.contact_height)) {
      end.height = end.height_floor = options_.contact_height;
    } else if (input.pad->has_deck()) {
      end.height = LowerUnderRoof(SpaceFor(options_, map), input.pad->MeanAt(t).p_WP, end.height);
      end.height_floor = std::min(end.height_floor, end.height);
    }
    return EndStateAt(*input.pad, end, t).state.p;
  }

  /// A place to look from, if there was no progress.
  void Search(const ReplanInput& input, const std::vector<LookCamera>& cameras,
              const OccupancyMap& map) {
    const Was& now = was_.back();
    const FreeSpace space = SpaceOf(input, map);
    const HullSpace hull = HullFor(options_, space, input.margins.Sum(), DeckOf(input));
    const double yaw = estimation::Yaw(input.vehicle.q_WB);
    lookout_.Keep(space);
    if (way_ == Way::kUp) {
      length_ = lookout_.Length(space, now.p_WB, now.goal_W);
      if (!IsStraight(map)) return Climb(hull);
      way_ = Way::kPlanned;
    }
    const bool progress = MadeProgress(space);
    const bool leaves = lookout_.end() != SpanSearch::End::kGoal;
    const bool follows = way_ == Way::kOut && leaves;
    NoteBest(map);
    if (detour_ > most_detour_) {
      if (IsStraighterAbove(space)) return Climb(hull);
      return NextDetour();
    }
    if (!leaves) way_ = Way::kPlanned;
    if (way_ == Way::kPlanned) {
      if (progress) return NoteOpen();
      if (!follows && !IsLongAgo(was_.front(), now, false)) return;
    }
    if (lookout_.Closed(space, now.p_WB, now.goal_W)) {
      NoteNoWay();
      if (turns_++ < kTurnsAround) LookAround(yaw, "begins: around, since no way is known");
      return;
    }
    NoteOpen();
    if (!std::isfinite(length_)) return;
    if (lookout_.end() == SpanSearch::End::kAnywhere && !up_) return Climb(hull);
    bool needs = true;
    if (way_ != Way::kOut) {
      if (prefers_wide_) lookout_.TakePath(space, now.p_WB, now.goal_W, true, false);
      needs = lookout_.NoteNeeded(hull, now.p_WB);
      if (leaves && (!needs || lookout_.seen() > kFollows)) way_ = Way::kOut;
    }
    if (way_ == Way::kOut) {
      lookout_.TakePath(space, now.p_WB, now.goal_W, prefers_wide_, true);
      needs = lookout_.NoteNeeded(hull, now.p_WB);
      if (lookout_.seen() > kOnwards) look_ = lookout_.Onwards(yaw, struck_);
      reason_ = "begins: along the way that leaves the map's window";
    }
    if (look_ != nullptr) return;
    // All was seen, and something is where the goal is: it may be gone, or never was.
    doubts_ = !needs && lookout_.NoteDoubted(space, now.goal_W);
    if (needs || doubts_) {
      look_ = lookout_.Choose(hull, cameras, input.vehicle, input.pull_W, struck_);
      reason_ = needs ? "begins: no progress, and cells on the way were never seen"
                      : "begins: no progress, and something is where the goal is";
    } else if (Stands() && !AtGoal()) {  // no plan leads there
      look_ = lookout_.Onwards(yaw, struck_);
      reason_ = "begins: all was seen, but no plan leads there";
    } else {
      return;
    }
    if (look_ != nullptr) return;
    struck_.clear();  // all were tried: again
    if (!needs || !Stays()) return;
    LookAround(yaw, "begins: around, since no place to look from is reached");
  }

  /// On from the last such look, if that was here: in between it may have turned back to its goal.
  void LookAround(double yaw, std::string_view reason) {
    const Eigen::Vector3d& here = was_.back().p_WB;
    const bool goes_on = around_ && (around_->p_WB - here).norm() < kNearer;
    look_ = lookout_.Around(here, goes_on ? around_->yaw : yaw);
    around_ = look_->from;
    reason_ = reason;
  }

  void NoteOpen() {
    turns_ = 0;
    no_way_.reset();
  }

  /// To a goal that stands.
  void NoteNoWay() {
    const Was &then = was_.front(), &now = was_.back();
    way_ = Way::kPlanned;
    if (!IsLongAgo(then, now, true)) return;
    if ((now.goal_W - then.goal_W).norm() > kNearer) return no_way_.reset();
    if (!no_way_) no_way_ = {now.t, looks_};
  }

  /// Around an obstacle that has no end one way is as good as any: after as long a way as that, over it. A straight way
  /// is none around.
  void NoteBest(const OccupancyMap& map) {
    const bool nearer = length_ < best_ - kNearer;
    if (nearer) {
      best_ = length_;
      way_ = Way::kPlanned;
      prefers_wide_ = false;
    }
    if (nearer || IsStraight(map)) {
      detour_ = 0.0;
      most_detour_ = kDetour;
      up_ = false;
    }
  }

  bool IsStraight(const OccupancyMap& map) const {
    const Was& now = was_.back();
    return length_ < lookout_.Least(map, now.p_WB, now.goal_W) + kNearer;
  }

  /// Above a wall the way is straight, above a roof it is not.
  bool IsStraighterAbove(const FreeSpace& space) {
    const OccupancyMap& map = *space.map;
    const Was& now = was_.back();
    const double side = map.resolution();
    const double top = side * (map.origin().z() + map.size().z());
    if (space.ceiling > top) return true;  // it is not known how high it may have to go
    Eigen::Vector3d above = now.p_WB;
    above.z() = std::max(above.z(), space.ceiling - 0.5 * side);
    const double here = length_ - lookout_.Least(map, now.p_WB, now.goal_W);
    const double there = lookout_.Length(space, above, now.goal_W);
    return there - lookout_.Least(map, above, now.goal_W) < here - kNearer;
  }

  /// As high as it can be seen to lead, and from there again.
  void Climb(const HullSpace& hull) {
    const Was& now = was_.back();
    way_ = Way::kUp;
    reason_ = "begins: over what is in the way";
    look_ = lookout_.Highest(hull, now.p_WB, now.goal_W);
    if (look_ != nullptr && look_->from.p_WB.z() > now.p_WB.z() + kHigher) return;
    look_ = nullptr;
    EndClimb();
  }

  /// From here on the next way around.
  void EndClimb() {
    way_ = Way::kPlanned;
    up_ = true;
    NextDetour();
  }

  void NextDetour() {
    detour_ = 0.0;
    most_detour_ *= 2.0;
  }

  /// The vehicle is nearer to where the goal was then, or to where it is now. The best moves with the goal.
  bool MadeProgress(const FreeSpace& space) {
    const Was &then = was_.front(), &now = was_.back();
    // A way is not shorter by more than what lies between where it begins.
    const bool moved = lookout_.Least(*space.map, then.p_WB, now.p_WB) >= kNearer;
    const auto nearer = [&](const Eigen::Vector3d& goal) {
      const double before = moved ? lookout_.Length(space, then.p_WB, goal) : 0.0;
      length_ = lookout_.Length(space, now.p_WB, goal);
      return length_ < before - kNearer;
    };
    const bool best_moved = (now.goal_W - best_goal_W_).norm() > kNearer;
    const double there = best_moved ? lookout_.Length(space, now.p_WB, best_goal_W_) : 0.0;
    const bool goal_moved = (now.goal_W - then.goal_W).norm() > kNearer;
    const bool to_then = goal_moved && nearer(then.goal_W);
    const bool to_now = nearer(now.goal_W);
    if (best_moved) {
      const double longer = length_ - there;
      best_ = std::isfinite(longer) ? best_ + longer : std::numeric_limits<double>::infinity();
      best_goal_W_ = now.goal_W;
    }
    return to_now || to_then;
  }

  /// Until the cells were seen, or were looked for in vain, or the place is not reached.
  bool StillLooks(const ReplanInput& input, const std::vector<LookCamera>& cameras,
                  const OccupancyMap& map) {
    const Was& now = was_.back();
    const int images = look_->camera < cameras.size() ? cameras[look_->camera].images : now.images;
    const double left = (now.p_WB - look_->from.p_WB).norm();
    const bool passes = way_ != Way::kUp && look_->cells.empty();  // from there the planner goes on
    if (passes && left < std::min(kPassesBy, 0.5 * look_->way)) return Ends("ends: passed");
    const auto unseen =
        std::count_if(look_->cells.begin(), look_->cells.end(), [&](const auto& cell) {
          return !map.IsObservedFree(cell) && (doubts_ || !map.IsOccupied(cell));
        });
    const auto cells = static_cast<double>(look_->cells.size());
    if (cells > 0.0 && static_cast<double>(unseen) <= kEnough * cells) return Ends("ends: seen");
    const double turn = estimation::Yaw(input.vehicle.q_WB) - look_->from.yaw;
    const bool near = left < kNear;
    const bool turned = std::abs(estimation::WrapAngle(turn)) < kTurnedTo;
    if (near && turned && now.speed < kSlow && !images_there_) {
      images_there_ = images;
    }
    const bool closed = SpaceFor(options_, map).Blocked(look_->from.p_WB);
    const bool in_vain = closed || (images_there_ && images >= *images_there_ + kLooks);
    const bool still = now.t >= was_.front().t + kTries && IsStill();
    const bool stands = !near && (Stands() || (InPart() && still));
    if (InPart() && (now.p_WB - Aim().p_WB).norm() < std::min(kNear, 0.5 * leg_)) {
      if (look_->cells.empty()) return Ends("ends: a part of the way was flown");
      reached_ = aim_;
      AimAt(look_->way_W.size() - 1);
      return true;
    }
    if (!near && still && AimsNearer(input, map)) return true;
    if (!in_vain && !stands && now.t < until_) return true;
    if (!closed && !in_vain) prefers_wide_ = true;
    if (way_ == Way::kUp && !near) EndClimb();
    if (passes) way_ = Way::kPlanned;
    if (struck_.size() == kUsualStruck) struck_.erase(struck_.begin());
    struck_.push_back(look_->from);
    return Ends(closed    ? "ends: something is there"
                : in_vain ? "ends: nothing more came in sight"
                          : "ends: not reached");
  }

  bool Ends(std::string_view words) {
    words_ = words;
    return false;
  }

  const ReplannerOptions options_;
  Lookout lookout_;
  std::vector<Was> was_;  // of the last steps; the first is as old as a question takes
  double asked_t_ = -std::numeric_limits<double>::infinity();  // for a place to look from, last
  double length_ = 0.0;  // of the shortest way, when it was last asked for
  double best_ = std::numeric_limits<double>::infinity();  // the least one so far, ...
  Eigen::Vector3d best_goal_W_ = Eigen::Vector3d::Zero();  // ... with the goal here,
  double detour_ = 0.0;                                    // and what was flown since [m], ...
  Eigen::Vector3d counted_W_ = Eigen::Vector3d::Zero();    // ... until here
  double most_detour_ = kDetour;
  Way way_ = Way::kPlanned;
  int turns_ = 0;                    // on the spot, since there is no way
  std::optional<Viewpoint> around_;  // of the last look on the spot
  bool doubts_ = false;              // of cells that are known to block
  bool prefers_wide_ = false;        // ways: it stood where the hull just fits
  bool up_ = false;                  // as high as it could climb, for that best
  const Look* look_ = nullptr;       // where it flies to; nullptr: to the goal
  std::size_t aim_ = 0, reached_ = 0;  // of the places on the way there
  double leg_ = 0.0;                   // from where it aimed there [m]
  double until_ = 0.0;               // it is to be over [s]
  std::optional<int> images_there_;  // used before the first one from there
  std::vector<Viewpoint> struck_;    // looked from in vain
  int looks_ = 0;                    // so far
  std::optional<NoWay> no_way_;
  std::string_view reason_, words_;  // for a look; how the last one began or ended
};

Scout::Scout(const ReplannerOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Scout::~Scout() = default;

const std::optional<NoWay>& Scout::no_way() const { return impl_->no_way(); }

std::string_view Scout::look_words() const { return impl_->look_words(); }

void Scout::Prepare(const OccupancyMap& map) { impl_->Prepare(map); }

std::optional<Viewpoint> Scout::Step(const ReplanInput& input,
                                     const std::vector<LookCamera>& cameras,
                                     const OccupancyMap& map, bool may_look) {
  return impl_->Step(input, cameras, map, may_look);
}

}  // namespace touchdown::planning
