// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/words/phrases.h"

#include <gtest/gtest.h>

#include "palmar/report/page/page_json.h"

namespace palmar::report {
namespace {

const Phrases& german() {
  static const Phrases phrases(Language::kGerman);
  return phrases;
}

TEST(Phrases, EnglishStaysAsItIs) {
  const Phrases english(Language::kEnglish);
  EXPECT_EQ(english("held by five fingers"), "held by five fingers");
}

TEST(Phrases, ValuesAreLookedUpInTheirTurnAndNumbersGetCommas) {
  EXPECT_EQ(german()("held by five fingers; the thumb's tip and the tip of the ring finger do not "
                     "touch"),
            "von fünf Fingern gehalten; die Kuppe des Daumens und die Kuppe des Ringfingers "
            "berühren es nicht");
  EXPECT_EQ(german()("not in balance after 71 steps: 1.2 N are left over at a grip force of 107 N"),
            "nach 71 Schritten nicht im Gleichgewicht: bei einer Greifkraft von 107 N bleiben "
            "1,2 N übrig");
  EXPECT_EQ(german()("in little_proximal: 0.0957 of 0.496 MPa"),
            "little_proximal: 0,0957 von 0,496 MPa");
}

TEST(Phrases, SentencesInARowAreLookedUpOneByOne) {
  EXPECT_EQ(german()("With a friction coefficient of 0.60 the load of 3.43 N is held; friction "
                     "could hold 37.4 times as much. The pressures' own sum, 42.1 N, is not part "
                     "of this balance: it is taken as held by the grip."),
            "Mit der Reibungszahl 0,60 wird die Last von 3,43 N gehalten; die Reibung könnte das "
            "37,4-Fache halten. Die Summe der Drücke selbst, 42,1 N, gehört nicht zu dieser "
            "Bilanz: sie gilt als vom Griff gehalten.");
}

TEST(Phrases, AShortSentenceDoesNotSwallowALongOne) {
  // "{grip} of the {part}" would fit these, too.
  EXPECT_EQ(german()("friction could hold it. Until the skin has taken it up, the product moves by "
                     "0.050 mm and turns by 0.011°, and 1.5 % of the loaded skin slips a little."),
            "friction could hold it. Bis die Haut sie aufgenommen hat, bewegt sich das Produkt um "
            "0,050 mm und dreht sich um 0,011°, und 1,5 % der belasteten Haut rutschen ein wenig.");
  EXPECT_EQ(german()("fixed hook of the loop handle, fingers through it, 50 % along it"),
            "Hakengriff: Henkel, Finger hindurch, bei 50 % der Länge");
}

TEST(Phrases, AProductsNameIsNoClause) {
  EXPECT_EQ(
      german()("Women of the US Army, 2010-2012: old is held by 2 of 3; fillet:long 3 mm is "
               "held by 3 of 3; old asks too much of nobody; fillet:long 3 mm asks too much "
               "of 1 of 3 (33 %: 1 by range of motion, 1 by nails); the difference between old and "
               "fillet:long 3 mm remains (0.315 and 0.437); at different grip forces (60 and "
               "50 N)."),
      "Frauen der US-Armee, 2010-2012: old wird von 2 von 3 gehalten; fillet:long 3 mm wird "
      "von 3 von 3 gehalten; old verlangt zu viel von: niemand; fillet:long 3 mm verlangt zu "
      "viel von: 1 von 3 (33 %: 1 durch Bewegungsbereich, 1 durch Nägel); der Unterschied zwischen "
      "old und "
      "fillet:long 3 mm bleibt (0,315 und 0,437); bei verschiedenen Greifkräften (60 und 50 "
      "N).");
}

TEST(Phrases, WhatFollowsAColonMayHaveOneOfItsOwn) {
  EXPECT_EQ(german()("thumb_flexion: voxels of 1.20 x 1.20 x 1.40 mm and noise of 5 % of the "
                     "contrast: bones' surfaces are expected within 0.4 mm only, and some bones "
                     "may be missed or have another one's name: look at the pictures")
                .find("pictures"),
            std::string::npos);
  EXPECT_EQ(german()("thumb_flexion: look at these bones, which may be found wrongly or bear a "
                     "wrong name: ulna is 8 mm long, where about 14 mm are expected; radius is 9 "
                     "mm long, where about 15 mm are expected"),
            "thumb_flexion: sehen Sie sich diese Knochen an, die falsch gefunden sein oder einen "
            "falschen Namen tragen können: ulna ist 8 mm lang, wo etwa 14 mm zu erwarten sind; "
            "radius ist 9 mm lang, wo etwa 15 mm zu erwarten sind");
}

TEST(Phrases, APlaceHoldsOneSentenceAtMost) {
  // "{low} against {high}" would fit all of it.
  EXPECT_EQ(german()("b has a lower contact area than a: 1 against 2 mm2, 50 % less (3 of 3 hands "
                     "hold both; these hands were chosen, not drawn by chance: a test means "
                     "nothing). So few hands prove nothing; 6 or more are needed.")
                .find("against"),
            std::string::npos);
}

TEST(Phrases, ClausesAndMusclesOfAVerdict) {
  EXPECT_EQ(german()("held by five fingers; the thumb's tip does not touch; but it slips out, "
                     "towards the wrist"),
            "von fünf Fingern gehalten; die Kuppe des Daumens berührt es nicht; aber es rutscht "
            "heraus, zu dem Handgelenk");
  EXPECT_EQ(german()("hardest: ring flexor digitorum profundus, 50 N; pressure alone, no friction"),
            "am stärksten: tiefer Fingerbeuger des Ringfingers, 50 N; nur Druck, keine Reibung");
  EXPECT_EQ(german()("woman of the 5th percentile (ANSUR II)"), "Frau, 5. Perzentil (ANSUR II)");
}

TEST(Phrases, NamesStayEvenIfTheyAreWords) {
  // A product whose name is a word of the table, and whose name has a point.
  EXPECT_EQ(german()("handle: how it is held, palm side."),
            "handle: wie es gehalten wird, Handtellerseite.");
  EXPECT_EQ(german()("v1.5: how it is held, palm side."),
            "v1.5: wie es gehalten wird, Handtellerseite.");
}

TEST(Phrases, WhatIsNotKnownStays) {
  EXPECT_EQ(german()("a sentence of nobody, by nobody"), "a sentence of nobody, by nobody");
  EXPECT_EQ(german()(""), "");
  EXPECT_EQ(german()("0.25"), "0.25");  // a number alone may be a name or a file
  // A list is looked up as a whole or not at all.
  EXPECT_EQ(german()("palm side, unknown side"), "palm side, unknown side");
}

TEST(Phrases, APlaceForNumbersTakesNumbersOnly) {
  EXPECT_EQ(german()("3 of 6"), "3 von 6");
  EXPECT_EQ(german()("queen of hearts"), "queen of hearts");
}

TEST(Phrases, JsonIsPutIntoTheLanguageButNotItsKeysAndNames) {
  PageJson json = {{"name", "palm side"},
                   {"status", "none"},
                   {"message", "held by five fingers"},
                   {"notes", {"2 pairs of triangles go through each other"}},
                   {"indices", {{{"key", "grip_force_n"}, {"name", "grip force"}}}},
                   {"source", "grip force.stl"},
                   {"pictures", {{{"title", "Hand and product, palm side"}}}}};
  put_in_language(json, german());
  EXPECT_EQ(json["name"], "palm side");
  EXPECT_EQ(json["status"], "none");
  EXPECT_EQ(json["message"], "von fünf Fingern gehalten");
  EXPECT_EQ(json["notes"][0], "2 Paare von Dreiecken durchdringen einander");
  EXPECT_EQ(json["indices"][0]["name"], "Greifkraft");
  EXPECT_EQ(json["source"], "grip force.stl");
  EXPECT_EQ(json["pictures"][0]["title"], "Hand und Produkt, Handtellerseite");
}

}  // namespace
}  // namespace palmar::report
