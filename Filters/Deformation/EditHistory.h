// SPDX-License-Identifier: BSD-3-Clause
/// @file EditHistory.h
/// @brief Edits of control points: the state of each edited point, and steps to undo and redo.
///
/// Knows points by number only; whoever calls it knows where they lie. Memory is that of the edits,
/// not of the model.
#pragma once

#include "Types.h"

#include <unordered_map>
#include <utility>

namespace nurbs
{

/// A control point of one of several models.
struct ControlPointKey
{
  std::int64_t Block = 0;
  std::int64_t Point = 0;
  /// The same point.
  bool operator==(const ControlPointKey& other) const
  {
    return this->Block == other.Block && this->Point == other.Point;
  }
};

/// What was done to one control point. Default: nothing.
struct ControlPointEdit
{
  /// What Value means.
  enum class Place
  {
    Unchanged,
    Displaced, ///< Value is added to the place in the input.
    Absolute   ///< Value is the place.
  };
  Place Kind = Place::Unchanged;
  Vec3 Value = Vec3::Zero();
  double Weight = 0.0; ///< The new weight, > 0; 0: that of the input.

  /// True if nothing was done.
  bool IsNone() const { return this->Kind == Place::Unchanged && this->Weight == 0.0; }
  /// The place of a point that the input has at `place`.
  Vec3 Apply(const Vec3& place) const;
  /// Moved further by `by`; an absolute place stays absolute.
  ControlPointEdit Moved(const Vec3& by) const;
};

/// The present edits and the way that led to them.
class EditHistory
{
public:
  /// A point and its edit.
  using Change = std::pair<ControlPointKey, ControlPointEdit>;

  /// The edit of a point, a default one if there is none.
  ControlPointEdit Find(const ControlPointKey& key) const;
  /// Number of points with an edit.
  std::size_t Size() const { return this->State.size(); }
  /// All of them, in no useful order.
  std::vector<Change> All() const;

  /// Sets the edits of points; each must be named once. One step, or part of the open group's. No
  /// step if nothing changes. What was undone before a step can't be redone after it.
  void Commit(const std::vector<Change>& after);

  /// Between BeginGroup and EndGroup all commits are one step; CancelGroup takes them back. Undo
  /// and Redo end the group first. Groups do not nest: a second BeginGroup ends the first.
  void BeginGroup();
  /// See BeginGroup.
  void EndGroup();
  /// See BeginGroup.
  void CancelGroup();
  /// True between BeginGroup and EndGroup.
  bool IsGroupOpen() const { return this->Grouping; }

  /// One step back or forth; false if there is none.
  bool Undo();
  /// Likewise.
  bool Redo();
  /// Steps that can be undone.
  std::size_t UndoCount() const { return this->Done.size(); }
  /// Steps that can be redone.
  std::size_t RedoCount() const { return this->Undone.size(); }

  /// Points whose edits were set since the last call, some perhaps more than once.
  std::vector<ControlPointKey> TakeTouched();

private:
  struct Hash
  {
    std::size_t operator()(const ControlPointKey& key) const;
  };
  struct StepChange
  {
    ControlPointKey Key;
    ControlPointEdit Before, After;
  };
  using Step = std::vector<StepChange>;

  void Set(const ControlPointKey& key, const ControlPointEdit& edit);

  std::unordered_map<ControlPointKey, ControlPointEdit, Hash> State;
  std::vector<Step> Done, Undone;
  bool Grouping = false;
  Step Group;
  std::unordered_map<ControlPointKey, std::size_t, Hash> InGroup; ///< Index in Group.
  std::vector<ControlPointKey> Touched;
};

} // namespace nurbs
