// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
#include "wakeline/track/track_list.hpp"

#include <gtest/gtest.h>

#include "wakeline/track/track_room.hpp"

namespace wakeline::track_list_test {
namespace {

TEST(TrackList, KeepsOlderTracksFirstAndEachInItsSlot) {
  TrackList tracks(4);
  for (int k = 1; k <= 4; ++k) tracks.open().id = k;
  EXPECT_TRUE(tracks.full());
  const int slot_of_3 = tracks.find(3)->slot;
  tracks.remove(tracks.find(2)->slot);
  EXPECT_EQ(tracks.find(2), nullptr);
  tracks.open().id = 5;
  std::vector<std::int64_t> ids;
  for (const int slot : tracks.slots()) ids.push_back(tracks.at(slot).id);
  EXPECT_EQ(ids, (std::vector<std::int64_t>{1, 3, 4, 5}));
  EXPECT_EQ(tracks.find(3)->slot, slot_of_3);
  for (const int slot : tracks.slots())
    if (tracks.at(slot).id % 2 == 1) tracks.vacate(slot);
  tracks.close_gaps();
  EXPECT_EQ(tracks.size(), 1);
  EXPECT_FALSE(tracks.in_use(slot_of_3));
  EXPECT_TRUE(tracks.in_use(tracks.find(4)->slot));
}

TEST(TrackList, ANewTrackHasNothingOfTheOneBefore) {
  TrackList tracks(1);
  Track& old = tracks.open();
  old.existence = 0.7;
  old.name[0] = 'x';
  old.hits = 9;
  tracks.remove(old.slot);
  const Track& track = tracks.open();
  EXPECT_EQ(track.existence, 0.0);
  EXPECT_EQ(track.label(), "");
  EXPECT_EQ(track.hits, 0);
}

TEST(TrackList, RestoresWhatItSavedAndRejectsWhatIsNoList) {
  TrackList tracks(3), restored(3), smaller(2);
  tracks.open().id = 7;
  tracks.open().id = 8;
  tracks.remove(tracks.find(7)->slot);
  Archive out;
  tracks.archive(out);
  Archive in(out.bytes());
  restored.archive(in);
  EXPECT_TRUE(in.ok() && in.at_end());
  ASSERT_NE(restored.find(8), nullptr);
  EXPECT_EQ(restored.find(8)->slot, tracks.find(8)->slot);
  EXPECT_TRUE(restored.in_use(restored.find(8)->slot));
  Archive again(out.bytes());
  smaller.archive(again);
  EXPECT_FALSE(again.ok());
  // The same slot twice
  Archive twice;
  std::vector<int> slots{1, 1}, vacant{0};
  twice(slots, 3);
  twice(vacant, 3);
  Archive bad(twice.bytes());
  restored.archive(bad);
  EXPECT_FALSE(bad.ok());
}

TEST(TrackRoom, TheWeakestTentativeTrackOfAFullListGoesFirst) {
  TrackList tracks(3);
  TrackRoom room(3);
  const double existence[] = {0.5, 0.2, 0.2};
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(room.has_room_for(0.0, tracks));
    Track& track = tracks.open();
    track.id = -1 - k;
    track.existence = existence[k];
  }
  EXPECT_FALSE(room.has_room_for(0.2, tracks)) << "no weaker one";
  EXPECT_TRUE(room.has_room_for(0.3, tracks));
  EXPECT_EQ(tracks.at(room.make_room()).id, -2) << "of equals the oldest";
  EXPECT_EQ(tracks.at(room.make_room()).id, -3);
  EXPECT_EQ(tracks.at(room.make_room()).id, -1);
  EXPECT_FALSE(room.has_room_for(1.0, tracks)) << "all are given up";
}

TEST(TrackRoom, AConfirmedTrackIsNeverDeletedForANewOne) {
  TrackList tracks(1);
  TrackRoom room(1);
  Track& track = tracks.open();
  track.status = TrackStatus::kHeld;
  EXPECT_FALSE(room.has_room_for(1.0, tracks));
}

}  // namespace
}  // namespace wakeline::track_list_test
