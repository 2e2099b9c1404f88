// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What constants are, in words of designers, for the first table of docs/method/sensitivity.md; all others have there the words beside
// them in the sources. The test sensitivity_page fails if one of these constants is gone.
export const plain_words = {
  "contact/contact.h:ContactOptions.cell_area": "the size of the cell over which a peak pressure is the mean",
  "contact/prepared/contact_patch.cpp:kLeastCover": "the least area, in cells, that a peak's force is divided by",
  "contact/prepared/contact_patch.cpp:kMostCover": "the largest area, in cells, that a peak's force is divided by",
  "grasp/equilibrium/digit_meeting.cpp:kPulps": "how soft digits are that press on each other",
  "grasp/equilibrium/digit_meeting.cpp:kPulpPower": "how fast the force between two digits grows as they press on each other",
  "grasp/grasp.h:PowerGraspOptions.finger_limit_depth": "how deep the product is pressed into the fingers as the hand closes",
  "grasp/grasp.h:PowerGraspOptions.palm_limit_depth": "how deep the product is pressed into the palm as the hand closes",
  "grasp/power/closing.cpp:kPreshape": "how far fingers are bent before they close",
  "grasp/power/closing.cpp:kThumbOut": "how far the thumb reaches out before it closes",
  "grasp/power/placement.cpp:kUsualProximal": "how far below the knuckles a handle lies in the palm",
  "grasp/rest/balance.h:BalanceOptions.friction": "the friction of skin on the product",
  "hand/tendons/digit_tendons.cpp:kSynek2019": "where the tendons of the fingers lie",
  "hand/tendons/hand_muscles.cpp:kThumbScale": "how strong thumbs are for the size of their muscles",
  "hand/tendons/joint_limits.cpp:kDipPerPip": "how far the last joint of a finger bends along with the middle one",
  "hand/tendons/joint_limits.h:LigamentModel.no_abduction": "how far a knuckle is bent when its finger can't be spread any more",
  "hand/tendons/tendon.cpp:kFingerCm2": "how thick the muscles of the fingers are",
  "hand/tendons/tendon.cpp:kThumbCm2": "how thick the muscles of the thumb are",
  "hand/tendons/tendon.h:kSpecificTension": "how strong muscles are for their thickness",
};
