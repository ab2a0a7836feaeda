// SPDX-License-Identifier: BSD-3-Clause
#include "EditHistory.h"

namespace nurbs
{

namespace
{

bool Same(const ControlPointEdit& a, const ControlPointEdit& b)
{
  return a.Kind == b.Kind && a.Value == b.Value && a.Weight == b.Weight;
}

} // namespace

Vec3 ControlPointEdit::Apply(const Vec3& place) const
{
  switch (this->Kind)
  {
    case Place::Displaced:
      return place + this->Value;
    case Place::Absolute:
      return this->Value;
    default:
      return place;
  }
}

ControlPointEdit ControlPointEdit::Moved(const Vec3& by) const
{
  ControlPointEdit moved = *this;
  moved.Value += by;
  if (moved.Kind != Place::Absolute)
  {
    moved.Kind = moved.Value == Vec3::Zero() ? Place::Unchanged : Place::Displaced;
  }
  return moved;
}

std::size_t EditHistory::Hash::operator()(const ControlPointKey& key) const
{
  return std::hash<std::int64_t>()(key.Point + 0x9E3779B97F4A7C15 * std::uint64_t(key.Block));
}

ControlPointEdit EditHistory::Find(const ControlPointKey& key) const
{
  const auto found = this->State.find(key);
  return found == this->State.end() ? ControlPointEdit() : found->second;
}

std::vector<EditHistory::Change> EditHistory::All() const
{
  return { this->State.begin(), this->State.end() };
}

void EditHistory::Set(const ControlPointKey& key, const ControlPointEdit& edit)
{
  if (edit.IsNone())
  {
    this->State.erase(key);
  }
  else
  {
    this->State[key] = edit;
  }
  this->Touched.push_back(key);
}

void EditHistory::Commit(const std::vector<Change>& after)
{
  Step step;
  for (const Change& change : after)
  {
    const ControlPointEdit before = this->Find(change.first);
    if (Same(before, change.second))
    {
      continue;
    }
    this->Set(change.first, change.second);
    step.push_back({ change.first, before, change.second });
  }
  if (step.empty())
  {
    return;
  }
  if (!this->Grouping)
  {
    this->Undone.clear();
    this->Done.push_back(std::move(step));
    return;
  }
  for (const StepChange& change : step)
  {
    const auto [at, isNew] = this->InGroup.try_emplace(change.Key, this->Group.size());
    if (isNew)
    {
      this->Group.push_back(change);
    }
    else
    {
      this->Group[at->second].After = change.After;
    }
  }
}

void EditHistory::BeginGroup()
{
  this->EndGroup();
  this->Grouping = true;
}

void EditHistory::EndGroup()
{
  Step step;
  for (const StepChange& change : this->Group)
  {
    if (!Same(change.Before, change.After))
    {
      step.push_back(change);
    }
  }
  if (!step.empty())
  {
    this->Undone.clear();
    this->Done.push_back(std::move(step));
  }
  this->Group.clear();
  this->InGroup.clear();
  this->Grouping = false;
}

void EditHistory::CancelGroup()
{
  for (const StepChange& change : this->Group)
  {
    this->Set(change.Key, change.Before);
  }
  this->Group.clear();
  this->InGroup.clear();
  this->Grouping = false;
}

bool EditHistory::Undo()
{
  this->EndGroup();
  if (this->Done.empty())
  {
    return false;
  }
  for (const StepChange& change : this->Done.back())
  {
    this->Set(change.Key, change.Before);
  }
  this->Undone.push_back(std::move(this->Done.back()));
  this->Done.pop_back();
  return true;
}

bool EditHistory::Redo()
{
  this->EndGroup();
  if (this->Undone.empty())
  {
    return false;
  }
  for (const StepChange& change : this->Undone.back())
  {
    this->Set(change.Key, change.After);
  }
  this->Done.push_back(std::move(this->Undone.back()));
  this->Undone.pop_back();
  return true;
}

std::vector<ControlPointKey> EditHistory::TakeTouched()
{
  return std::exchange(this->Touched, {});
}

} // namespace nurbs
