// SPDX-License-Identifier: BSD-3-Clause
#include "EditHistory.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace
{

using nurbs::ControlPointEdit;
using nurbs::ControlPointKey;
using nurbs::EditHistory;
using nurbs::Vec3;

/// All edits as plain numbers, to be compared.
using State = std::map<std::pair<std::int64_t, std::int64_t>, std::vector<double>>;

State StateOf(const EditHistory& history)
{
  State state;
  for (const auto& [key, edit] : history.All())
  {
    state[{ key.Block, key.Point }] = { double(edit.Kind), edit.Value[0], edit.Value[1],
      edit.Value[2], edit.Weight };
  }
  return state;
}

ControlPointEdit Weight(double weight)
{
  ControlPointEdit edit;
  edit.Weight = weight;
  return edit;
}

TEST(EditHistory, AnEditIsAppliedToAPlace)
{
  ControlPointEdit edit;
  EXPECT_TRUE(edit.IsNone());
  EXPECT_EQ(edit.Apply(Vec3(1, 2, 3)), Vec3(1, 2, 3));
  edit = edit.Moved(Vec3(1, 0, -1)).Moved(Vec3(0, 4, 0));
  EXPECT_EQ(edit.Apply(Vec3(1, 2, 3)), Vec3(2, 6, 2));
  EXPECT_TRUE(edit.Moved(Vec3(-1, -4, 1)).IsNone());
  edit.Kind = ControlPointEdit::Place::Absolute;
  EXPECT_EQ(edit.Moved(Vec3(1, 1, 1)).Apply(Vec3(7, 7, 7)), Vec3(2, 5, 0));
  EXPECT_FALSE(Weight(2.0).IsNone());
}

// Every state on the way must come back, step by step, whatever was grouped.
TEST(EditHistory, RandomStepsBackAndForth)
{
  std::mt19937 random(5);
  EditHistory history;
  std::vector<State> states{ StateOf(history) };
  for (int step = 0; step < 200; ++step)
  {
    const bool grouped = random() % 3 == 0;
    if (grouped)
    {
      history.BeginGroup();
    }
    for (int k = grouped ? int(random() % 5) : 1; k > 0; --k)
    {
      std::vector<EditHistory::Change> changes;
      for (std::int64_t point = random() % 4; point < 12; point += 1 + random() % 5)
      {
        const ControlPointKey key{ std::int64_t(random() % 2), point };
        ControlPointEdit edit = history.Find(key).Moved(Vec3(random() % 7, 1, 2));
        edit.Weight = random() % 2 ? 0.0 : 1.0 + random() % 3;
        changes.emplace_back(key, random() % 4 ? edit : ControlPointEdit());
      }
      history.Commit(changes);
    }
    history.EndGroup();
    if (StateOf(history) != states.back())
    {
      states.push_back(StateOf(history));
    }
  }
  ASSERT_EQ(history.UndoCount() + 1, states.size());
  ASSERT_GT(states.size(), 100u);
  for (std::size_t k = states.size() - 1; k-- > 0;)
  {
    ASSERT_TRUE(history.Undo());
    ASSERT_EQ(StateOf(history), states[k]) << k;
  }
  EXPECT_FALSE(history.Undo());
  EXPECT_EQ(history.Size(), 0u);
  for (std::size_t k = 1; k < states.size(); ++k)
  {
    ASSERT_TRUE(history.Redo());
    ASSERT_EQ(StateOf(history), states[k]) << k;
  }
  EXPECT_FALSE(history.Redo());
}

TEST(EditHistory, ACancelledGroupLeavesNoTrace)
{
  EditHistory history;
  history.Commit({ { { 0, 1 }, Weight(2.0) } });
  history.Commit({ { { 0, 2 }, Weight(3.0) } });
  history.Undo();
  const State before = StateOf(history);
  history.BeginGroup();
  history.Commit({ { { 0, 1 }, Weight(5.0) }, { { 1, 1 }, Weight(5.0) } });
  history.Commit({ { { 0, 1 }, ControlPointEdit() } });
  history.TakeTouched();
  history.CancelGroup();
  EXPECT_EQ(StateOf(history), before);
  EXPECT_EQ(history.TakeTouched().size(), 2u) << "points to be rewritten";
  EXPECT_EQ(history.UndoCount(), 1u);
  EXPECT_EQ(history.RedoCount(), 1u) << "nothing happened, so redo is still possible";
  EXPECT_TRUE(history.Redo());
  history.Undo();
  history.Commit({ { { 0, 4 }, Weight(2.0) } });
  EXPECT_EQ(history.RedoCount(), 0u);
}

TEST(EditHistory, NothingIsNoStep)
{
  EditHistory history;
  history.Commit({ { { 0, 1 }, ControlPointEdit() } });
  EXPECT_EQ(history.UndoCount(), 0u);
  EXPECT_TRUE(history.TakeTouched().empty());
  history.BeginGroup();
  history.Commit({ { { 0, 1 }, Weight(2.0) } });
  history.Commit({ { { 0, 1 }, ControlPointEdit() } });
  history.EndGroup();
  EXPECT_EQ(history.UndoCount(), 0u);
}

} // namespace
