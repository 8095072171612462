// SPDX-FileCopyrightText: 2026 Wakeline developers
// SPDX-License-Identifier: MIT
//
// The items of ASTERIX categories 010, 034, 048 and 062 in the order of their field specifications:
// EUROCONTROL-SPEC-0149, part 7 (010, edition 1.1), 2b (034, 1.29), 4 (048, 1.32), 9 (062, 1.21).
#pragma once

#include <array>

#include "wakeline/core/asterix.hpp"

namespace wakeline::asterix {

namespace cat010 {

inline constexpr unsigned kCategory = 10;
/// Items in the order of their bits.
enum Item : std::size_t {
  kSource,
  kMessageType,
  kDescriptor,
  kTimeOfDay,
  kWgs84,
  kPolar,
  kCartesian,
  kVelocityPolar,
  kVelocityCartesian,
  kTrackNumber,
  kTrackStatus,
  kMode3A,
  kAddress,
  kIdentification,
  kModeS,
  kFleet,
  kFlightLevel,
  kHeight,
  kSize,
  kSystemStatus,
  kMessage,
  kDeviation,
  kPresence,
  kAmplitude,
  kAcceleration,
  kSpare,
  kSpecial,
  kExpansion,
  kItems
};
inline constexpr std::array<ItemForm, kItems> kForms{{
    {"I010/010", Length::kFixed, 2},
    {"I010/000", Length::kFixed, 1},
    {"I010/020", Length::kExtended},
    {"I010/140", Length::kFixed, 3},
    {"I010/041", Length::kFixed, 8},
    {"I010/040", Length::kFixed, 4},
    {"I010/042", Length::kFixed, 4},
    {"I010/200", Length::kFixed, 4},
    {"I010/202", Length::kFixed, 4},
    {"I010/161", Length::kFixed, 2},
    {"I010/170", Length::kExtended},
    {"I010/060", Length::kFixed, 2},
    {"I010/220", Length::kFixed, 3},
    {"I010/245", Length::kFixed, 7},
    {"I010/250", Length::kRepeated, 8},
    {"I010/300", Length::kFixed, 1},
    {"I010/090", Length::kFixed, 2},
    {"I010/091", Length::kFixed, 2},
    {"I010/270", Length::kExtended},
    {"I010/550", Length::kFixed, 1},
    {"I010/310", Length::kFixed, 1},
    {"I010/500", Length::kFixed, 4},
    {"I010/280", Length::kRepeated, 2},
    {"I010/131", Length::kFixed, 1},
    {"I010/210", Length::kFixed, 2},
    {"spare", Length::kSpare},
    {"SP", Length::kOwn},
    {"RE", Length::kOwn},
}};

}  // namespace cat010

namespace cat034 {

inline constexpr unsigned kCategory = 34;
/// Items in the order of their bits.
enum Item : std::size_t {
  kSource,
  kMessageType,
  kTimeOfDay,
  kSector,
  kPeriod,
  kConfiguration,
  kProcessing,
  kCounts,
  kWindow,
  kFilter,
  kRadarPosition,
  kCollimation,
  kExpansion,
  kSpecial,
  kItems
};
inline constexpr std::array<ItemForm, 7> kConfigurationParts{{
    {"COM", Length::kFixed, 1},
    {"spare", Length::kSpare},
    {"spare", Length::kSpare},
    {"PSR", Length::kFixed, 1},
    {"SSR", Length::kFixed, 1},
    {"MDS", Length::kFixed, 2},
    {"spare", Length::kSpare},
}};
inline constexpr std::array<ItemForm, 7> kProcessingParts{{
    {"COM", Length::kFixed, 1},
    {"spare", Length::kSpare},
    {"spare", Length::kSpare},
    {"PSR", Length::kFixed, 1},
    {"SSR", Length::kFixed, 1},
    {"MDS", Length::kFixed, 1},
    {"spare", Length::kSpare},
}};
inline constexpr std::array<ItemForm, kItems> kForms{{
    {"I034/010", Length::kFixed, 2},
    {"I034/000", Length::kFixed, 1},
    {"I034/030", Length::kFixed, 3},
    {"I034/020", Length::kFixed, 1},
    {"I034/041", Length::kFixed, 2},
    {"I034/050", Length::kCompound, 1, kConfigurationParts},
    {"I034/060", Length::kCompound, 1, kProcessingParts},
    {"I034/070", Length::kRepeated, 2},
    {"I034/100", Length::kFixed, 8},
    {"I034/110", Length::kFixed, 1},
    {"I034/120", Length::kFixed, 8},
    {"I034/090", Length::kFixed, 2},
    {"RE", Length::kOwn},
    {"SP", Length::kOwn},
}};

}  // namespace cat034

namespace cat048 {

inline constexpr unsigned kCategory = 48;
/// Items in the order of their bits.
enum Item : std::size_t {
  kSource,
  kTimeOfDay,
  kDescriptor,
  kPolar,
  kMode3A,
  kFlightLevel,
  kPlotCharacteristics,
  kAddress,
  kIdentification,
  kModeS,
  kTrackNumber,
  kCartesian,
  kVelocityPolar,
  kTrackStatus,
  kTrackQuality,
  kWarnings,
  kMode3AConfidence,
  kModeC,
  kHeight,
  kDoppler,
  kCapability,
  kResolution,
  kMode1,
  kMode2,
  kMode1Confidence,
  kMode2Confidence,
  kSpecial,
  kExpansion,
  kItems
};
inline constexpr std::array<ItemForm, 7> kCharacteristicsParts{{
    {"SRL", Length::kFixed, 1},
    {"SRR", Length::kFixed, 1},
    {"SAM", Length::kFixed, 1},
    {"PRL", Length::kFixed, 1},
    {"PAM", Length::kFixed, 1},
    {"RPD", Length::kFixed, 1},
    {"APD", Length::kFixed, 1},
}};
inline constexpr std::array<ItemForm, 2> kDopplerParts{{
    {"CAL", Length::kFixed, 2},
    {"RDS", Length::kRepeated, 6},
}};
inline constexpr std::array<ItemForm, kItems> kForms{{
    {"I048/010", Length::kFixed, 2},
    {"I048/140", Length::kFixed, 3},
    {"I048/020", Length::kExtended},
    {"I048/040", Length::kFixed, 4},
    {"I048/070", Length::kFixed, 2},
    {"I048/090", Length::kFixed, 2},
    {"I048/130", Length::kCompound, 1, kCharacteristicsParts},
    {"I048/220", Length::kFixed, 3},
    {"I048/240", Length::kFixed, 6},
    {"I048/250", Length::kRepeated, 8},
    {"I048/161", Length::kFixed, 2},
    {"I048/042", Length::kFixed, 4},
    {"I048/200", Length::kFixed, 4},
    {"I048/170", Length::kExtended},
    {"I048/210", Length::kFixed, 4},
    {"I048/030", Length::kExtended},
    {"I048/080", Length::kFixed, 2},
    {"I048/100", Length::kFixed, 4},
    {"I048/110", Length::kFixed, 2},
    {"I048/120", Length::kCompound, 1, kDopplerParts},
    {"I048/230", Length::kFixed, 2},
    {"I048/260", Length::kFixed, 7},
    {"I048/055", Length::kFixed, 1},
    {"I048/050", Length::kFixed, 2},
    {"I048/065", Length::kFixed, 1},
    {"I048/060", Length::kFixed, 2},
    {"SP", Length::kOwn},
    {"RE", Length::kOwn},
}};

}  // namespace cat048

/// Those items of a record that are written here; their forms need no table.
namespace cat062 {

inline constexpr unsigned kCategory = 62;
/// Items in the order of their bits.
enum Item : std::size_t {
  kSource = 0,
  kService = 2,
  kTimeOfDay = 3,
  kWgs84 = 4,
  kCartesian = 5,
  kVelocity = 6,
  kIdentification = 9,
  kTrackNumber = 11,
  kTrackStatus = 12,
  kUpdateAges = 13,
  kModeOfMovement = 14,
  kAccuracies = 26,
};

}  // namespace cat062

}  // namespace wakeline::asterix
