#include "common/border_settling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/growth_state.h"
#include "common/plane_contacts.h"

namespace foresight {
namespace {

// How two touching planes meet.
struct Meeting {
  double first_to_second =
      0.0;  // sum of signed distances of cells of the first plane, some way inside it, from the second
  double second_to_first = 0.0;
  int first_cells = 0, second_cells = 0;

  // -1: both lie behind the other: a convex edge; 1: both before the other: a concave one; 0: no crease, as at a step.
  [[nodiscard]] int crease(double least) const {
    if (first_cells == 0 || second_cells == 0) return 0;
    const double a = first_to_second / first_cells;
    const double b = second_to_first / second_cells;
    if (a < -least && b < -least) return -1;
    return a > least && b > least ? 1 : 0;
  }
};

// Of all planes that touch.
class Meetings {
 public:
  explicit Meetings(std::size_t planes) : first_(planes + 1, -1) {}

  // Of two planes by their labels, the lower first.
  Meeting& of(std::pair<int, int> labels) {
    int& first = first_[static_cast<std::size_t>(labels.first)];
    for (int i = first; i >= 0; i = entry(i).next) {
      if (entry(i).second == labels.second) return entry(i).meeting;
    }
    entries_.push_back({labels.second, first, {}, 0});
    first = static_cast<int>(entries_.size()) - 1;
    return entries_.back().meeting;
  }
  void find_creases(double least) {
    for (Entry& each : entries_) each.crease = each.meeting.crease(least);
  }
  // Meeting::crease(), or 0 where the planes did not touch.
  [[nodiscard]] int crease(std::pair<int, int> labels) const {
    for (int i = first_[static_cast<std::size_t>(labels.first)]; i >= 0;) {
      const Entry& each = entries_[static_cast<std::size_t>(i)];
      if (each.second == labels.second) return each.crease;
      i = each.next;
    }
    return 0;
  }

 private:
  struct Entry {
    int second, next;  // the higher label; the next entry of the same lower one, or -1
    Meeting meeting;
    int crease;
  };
  [[nodiscard]] Entry& entry(int i) { return entries_[static_cast<std::size_t>(i)]; }

  PoolVector<int> first_;  // by the lower label: an entry, or -1
  PoolVector<Entry> entries_;
};

// The cell `steps` links away from a border, or -1 when that is another plane's. next: the way to go.
template <typename Next>
int some_way_inside(Growth& growth, int cell, int steps, Next&& next) {
  const int own = growth.label(cell);
  for (int i = 0; i < steps; ++i) {
    cell = next(cell);
    if (cell < 0 || growth.label(cell) != own) return -1;
  }
  return cell;
}

Meetings find_meetings(Growth& growth, const PoolVector<Contact>& contacts) {
  Meetings meetings(growth.found.planes.size());
  const CellConnectivity& links = growth.connectivity;
  const int steps = growth.options.seed_block;
  const auto meet = [&](int before, int after, auto&& backwards, auto&& forwards) {
    const int a = growth.label(before);
    const int b = growth.label(after);
    Meeting& meeting = meetings.of(std::minmax(a, b));
    const int in_a = some_way_inside(growth, before, steps, backwards);
    const int in_b = some_way_inside(growth, after, steps, forwards);
    if (in_a >= 0) {
      (a < b ? meeting.first_to_second : meeting.second_to_first) += growth.signed_distance(in_a, b);
      ++(a < b ? meeting.first_cells : meeting.second_cells);
    }
    if (in_b >= 0) {
      (b < a ? meeting.first_to_second : meeting.second_to_first) += growth.signed_distance(in_b, a);
      ++(b < a ? meeting.first_cells : meeting.second_cells);
    }
  };
  const auto left = [&](int cell) { return links.left(cell); };
  const auto right = [&](int cell) { return links.right(cell); };
  const auto up = [&](int cell) { return links.up(cell); };
  const auto down = [&](int cell) { return links.down(cell); };
  for (const auto& [cell, next] : contacts) {
    if (next - cell < growth.image.columns) {
      meet(cell, next, left, right);
    } else {
      meet(cell, next, up, down);
    }
  }
  meetings.find_creases(growth.options.plane_sigma);
  return meetings;
}

// How much farther plane `other` lies than plane `own` along the line of sight of a cell, relative to its data point p:
// a plane lies at offset / (normal . p) of it.
double other_behind_own(const Growth& growth, int cell, int own, int other) {
  const auto along_sight = [&](int label) {
    const double offset = growth.found.planes[static_cast<std::size_t>(label - 1)].offset;
    return offset / (growth.signed_distance(cell, label) + offset);
  };
  return along_sight(other) - along_sight(own);
}

// Whether the way from a cell to its neighbour `next` leads across the crease of two planes rather than along it.
bool leads_across(const Growth& growth, int cell, int next, int own, int other) {
  const double here = other_behind_own(growth, cell, own, other);
  const double step = std::abs(other_behind_own(growth, next, own, other) - here);
  const bool is_row = std::abs(next - cell) < growth.image.columns;
  const CellConnectivity& links = growth.connectivity;
  for (const int beside :
       is_row ? std::array{links.up(cell), links.down(cell)} : std::array{links.left(cell), links.right(cell)}) {
    if (beside >= 0 && std::abs(other_behind_own(growth, beside, own, other) - here) > step) return false;
  }
  return true;
}

// Whether a cell of plane `own` belongs to plane `other`, of which its neighbour `next` is.
bool belongs_to(const Growth& growth, int cell, int next, int own, int other, int crease) {
  if (!growth.within_reach(cell, other)) return false;
  if (!growth.within_reach(cell, own)) return true;
  if (crease == 0) return growth.distance(cell, other) < growth.distance(cell, own);
  // At a convex edge the farther of the two planes is the surface, at a concave one the nearer.
  const double behind = other_behind_own(growth, cell, own, other);
  return (crease < 0 ? behind > 0.0 : behind < 0.0) && leads_across(growth, cell, next, own, other);
}

// Cells that either of two planes that meet could have, from their border inwards.
PoolVector<int> doubtful_cells(Growth& growth) {
  struct Doubt {
    int cell, other;
  };
  PoolVector<Doubt> doubts;
  PoolVector<char> doubtful(growth.found.labels.size(), 0);
  const auto doubt = [&](int cell, int other) {
    if (doubtful[static_cast<std::size_t>(cell)] != 0 || !growth.within_reach(cell, other)) return;
    doubtful[static_cast<std::size_t>(cell)] = 1;
    doubts.push_back({cell, other});
  };
  for (const auto& [cell, next] : contacts_of(growth.connectivity, growth.found.labels)) {
    doubt(cell, growth.label(next));
    doubt(next, growth.label(cell));
  }
  for (std::size_t i = 0; i < doubts.size(); ++i) {  // grows while it is worked off
    const auto [cell, other] = doubts[i];
    growth.connectivity.for_each_neighbour(cell, [&, other = other, own = growth.label(cell)](int next) {
      if (growth.label(next) == own) doubt(next, other);
    });
  }
  PoolVector<int> cells;
  cells.reserve(doubts.size());
  for (const Doubt& d : doubts) cells.push_back(d.cell);
  return cells;
}

// Planes also cross where there is no crease, as that of a block's side does on the floor beside the block, and there
// the data points cannot tell one from the other. So doubtful cells go to the plane whose undoubted cells are nearest.
void share_out_doubtful_cells(Growth& growth) {
  PoolVector<int> doubtful = doubtful_cells(growth);
  PoolVector<double> doubted(growth.found.planes.size() + 1, 0.0);
  for (const int cell : doubtful) ++doubted[static_cast<std::size_t>(growth.label(cell))];
  // A plane that is nearly all in doubt, like a thin face along a crease, keeps what it has.
  PoolVector<char> keeps_all(doubted.size(), 0);
  for (std::size_t label = 1; label < doubted.size(); ++label) {
    keeps_all[label] = doubted[label] > 0.75 * growth.sums(static_cast<int>(label)).count() ? 1 : 0;
  }
  std::erase_if(doubtful, [&](int cell) { return keeps_all[static_cast<std::size_t>(growth.label(cell))] != 0; });
  for (const int cell : doubtful) growth.release(cell);
  PoolVector<int> front;
  for (const int cell : doubtful) {
    growth.connectivity.for_each_neighbour(cell, [&](int next) {
      if (growth.label(next) != 0) front.push_back(next);
    });
  }
  for (std::size_t i = 0; i < front.size(); ++i) {  // grows while it is worked off
    const int own = growth.label(front[i]);
    growth.connectivity.for_each_neighbour(front[i], [&](int next) {
      if (growth.label(next) != 0 || !growth.within_reach(next, own)) return;
      growth.join(next, own);
      front.push_back(next);
    });
  }
}

}  // namespace

void settle_borders(const RangeImage& image, const CellConnectivity& connectivity, const SegmentationOptions& options,
                    PlaneLabels& found, const Stop& stop) {
  Growth growth{image, connectivity, options, found};
  growth.measure_reach();
  share_out_doubtful_cells(growth);
  if (stop && stop()) return;
  const PoolVector<Contact> contacts = contacts_of(growth.connectivity, growth.found.labels);
  const Meetings meetings = find_meetings(growth, contacts);
  if (stop && stop()) return;
  // A border moves by as many cells as the patches that straddled it are wide, not farther: planes also cross where
  // there is no crease, as that of a block's side does on the floor beside the block.
  const auto farthest = static_cast<unsigned char>(options.seed_block);
  PoolVector<unsigned char> moved(found.labels.size(),
                                  0);  // by cell: how far the border has come when it takes the cell
  PoolVector<int> border;
  for (const auto& [cell, next] : contacts) border.insert(border.end(), {cell, next});
  for (std::size_t i = 0; i < border.size(); ++i) {  // grows while it is worked off
    const int cell = border[i];
    const int own = growth.label(cell);
    const unsigned char steps = moved[static_cast<std::size_t>(cell)];
    if (steps > farthest) continue;
    int best = own;
    connectivity.for_each_neighbour(cell, [&](int next) {
      const int other = growth.label(next);
      if (other == 0 || other == own || other == best) return;
      const int crease = meetings.crease(std::minmax(own, other));
      if (!belongs_to(growth, cell, next, own, other, crease)) return;
      if (best == own || growth.distance(cell, other) < growth.distance(cell, best)) best = other;
    });
    if (best == own) continue;
    growth.release(cell);
    growth.join(cell, best);
    moved[static_cast<std::size_t>(cell)] = static_cast<unsigned char>(steps + 1);
    connectivity.for_each_neighbour(cell, [&](int next) {
      if (growth.label(next) == 0 || growth.label(next) == best) return;
      unsigned char& come = moved[static_cast<std::size_t>(next)];
      come = std::max(come, static_cast<unsigned char>(steps + 1));
      border.push_back(next);
    });
  }
}

}  // namespace foresight
