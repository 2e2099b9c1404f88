// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/population/dimension_table_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

namespace palmar::records {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Optional;

population::DimensionTable parsed(const std::string& text, const TableReading& reading = {}) {
  return parse_dimension_table(text, "t.csv", reading);
}

std::string fault(const std::string& text, const TableReading& reading = {}) {
  try {
    parsed(text, reading);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(DimensionTable, ReadsUnitsGroupsAndMissingValues) {
  const population::DimensionTable table = parsed(
      "id,sex,age,hand_length_mm,handbreadth (cm),Hand circumference [in],thumb_span_mm\n"
      "a,F,23,181.5,8.1,7.5,140\n"
      "b,M,31,NA,8.9,8,-\n"
      "\n"
      "c,,44,176,,7.25,.\n");
  EXPECT_EQ(table.subjects(), 3);
  EXPECT_THAT(table.lines, ElementsAre(2, 3, 5));
  EXPECT_THAT(table.column("hand_length").values,
              ElementsAre(Optional(181.5), std::nullopt, Optional(176.0)));
  EXPECT_THAT(table.column("hand_width").values,
              ElementsAre(Optional(81.0), Optional(89.0), std::nullopt));
  EXPECT_DOUBLE_EQ(*table.column("handcircumference").values[1], 203.2);
  EXPECT_THAT(table.column("sex").texts, ElementsAre("F", "M", ""));
  EXPECT_EQ(table.column("age").unit, "years");
  EXPECT_EQ(table.column("thumb_span").unit, "mm");
  EXPECT_EQ(table.measures().size(), 4U);
  EXPECT_THAT(table.notes, testing::Contains(HasSubstr("turned from cm into mm")));
}

TEST(DimensionTable, ReadsWhatSpreadsheetsWrite) {
  // Byte order mark, separator stated, CRLF, decimal comma, quoted heading with the separator in
  // it, row numbers without a heading, an empty column and empty rows at the end.
  const population::DimensionTable table = parsed(
      "\xEF\xBB\xBFsep=;\r\n;\"Hand length; right [mm]\";Hand length [mm];Geschlecht;\r\n"
      "1;181,5;182;w;\r\n2;193,25;194;m;\r\n3;176;177;w;\r\n;;;;\r\n;;;;\r\n");
  EXPECT_EQ(table.subjects(), 3);
  EXPECT_DOUBLE_EQ(*table.column("hand_length_right").values[1], 193.25);
  EXPECT_DOUBLE_EQ(*table.column("hand_length").values[2], 177.0);
  EXPECT_THAT(table.column("geschlecht").texts, ElementsAre("w", "m", "w"));
  const population::DimensionTable tabs = parsed("hand_length_mm\tsex\n181,5\tF\n190\tM\n200\tM\n");
  EXPECT_DOUBLE_EQ(*tabs.column("hand_length").values[0], 181.5);
}

TEST(DimensionTable, AUnitMayBeGivenForHeadingsWithout) {
  const std::string text = "handlength,handbreadth,weight\n181,81,60\n193,89,70\n176,76,80\n";
  EXPECT_THAT(fault(text), AllOf(HasSubstr("t.csv:1: column 1 (handlength): no unit"),
                                 HasSubstr("\"handlength_mm\""), HasSubstr("setting \"unit\"")));
  const population::DimensionTable table = parsed(text, {.unit = "mm"});
  EXPECT_EQ(table.column("hand_width").unit, "mm");
  EXPECT_EQ(table.column("weight").unit, "");
  EXPECT_THROW(parsed(text, {.unit = "furlong"}), UsageError);
}

TEST(DimensionTable, BadTablesAreNamedByLineAndColumn) {
  const std::string head = "sex,hand_length_mm,hand_width_mm\n";
  EXPECT_THAT(fault(head + "F,181,80\nM,abc,90\nF,170,75\n"),
              AllOf(HasSubstr("t.csv:3: column 2 (hand_length_mm): \"abc\" is no number")));
  EXPECT_THAT(fault(head + "F,181 mm,80\nM,190,90\nF,170,75\n"),
              HasSubstr("t.csv:2: column 2 (hand_length_mm): \"181 mm\" is no number (a unit"));
  EXPECT_THAT(fault(head + "F,\"181,5\",80\nM,190,90\nF,170,75\n"), HasSubstr("semicolons"));
  EXPECT_THAT(fault(head + "F,inf,80\nM,190,90\nF,170,75\n"), HasSubstr("\"inf\" is no number"));
  EXPECT_THAT(fault(head + "F,-181,80\nM,190,90\nF,170,75\n"), HasSubstr("a length above 0"));
  EXPECT_THAT(fault(head + "F,181\nM,190,90\nF,170,75\n"),
              HasSubstr("t.csv:2: it has 2 cells; the header has 3"));
  EXPECT_THAT(fault(head + "F,1e300,80\nM,190,90\n"),
              AllOf(HasSubstr("t.csv:2: column 2 (hand_length_mm): 1e300"),
                    HasSubstr("above 0 and below"), HasSubstr("is 90 to 260 mm")));
  EXPECT_THAT(fault(head), HasSubstr("t.csv:1: 0 subjects"));
  EXPECT_THAT(fault("sex,hand_length_mm,handlength (cm)\nF,181,18\nM,190,19\nF,170,17\n"),
              HasSubstr("t.csv:1: columns 2 (hand_length_mm) and 3 (handlength (cm)) are both "
                        "hand_length"));
  EXPECT_THAT(fault("hand_length_mm,hand_length_mm\n1,2\n1,2\n1,2\n"),
              HasSubstr("columns 1 and 2 are both called"));
  EXPECT_THAT(fault("hand_length_kg\n1\n2\n3\n"), HasSubstr("\"kg\" is no unit of length"));
  EXPECT_THAT(fault("hand_length_mm,\n181,5\n190,6\n170,7\n"),
              HasSubstr("t.csv:1: column 2 has no name"));
  EXPECT_THAT(fault("hand_length_mm;x\n181,5;1\n190.5;1\n170;1\n"),
              HasSubstr("t.csv:3: column 1 (hand_length_mm): a decimal point where"));
  EXPECT_THAT(fault("weight_kg,hand_length_mm\nheavy,181\n70,190\n80,170\n"),
              HasSubstr("t.csv:2: column 1 (weight_kg): \"heavy\" is no number"));
  EXPECT_THAT(fault("age_years,x\n20,1\n200,2\n30,3\n"), HasSubstr("0 to 130 years"));
}

TEST(DimensionTable, WrongUnitsAreFoundByTheSizeOfHands) {
  EXPECT_THAT(fault("hand_length_mm\n18.1\n19.3\n17.6\n"),
              AllOf(HasSubstr("t.csv:1: column 1 (hand_length_mm): the median is 18.1 mm"),
                    HasSubstr("90 to 260 mm"), HasSubstr("in cm")));
  EXPECT_THAT(fault("hand_length_cm\n181\n193\n176\n"), HasSubstr("in mm: is the unit right?"));
  EXPECT_THAT(fault("hand_width_in\n81\n89\n76\n"), HasSubstr("in mm"));
  EXPECT_THAT(fault("hand_width_mm\n3.2\n3.5\n3.0\n"), HasSubstr("in in"));
  EXPECT_THAT(fault("hand_length_mm\n0.181\n0.193\n0.176\n"), HasSubstr("in m:"));
  // Lengths of the bone, not of the segment.
  EXPECT_THAT(fault("index_proximal_length_mm\n44\n46\n47\n"), HasSubstr("between creases"));
  EXPECT_THAT(fault("hand_length_mm\n181\n1930\n176\n18.1\n"),
              HasSubstr("t.csv:3: column 1 (hand_length_mm): 1930 mm; a hand's hand_length is 90 "
                        "to 260 mm (and 1 more cells)"));
}

TEST(DimensionTable, FilesThatAreNoTablesAreRefused) {
  const formats::TestFolder folder;
  EXPECT_THROW(read_dimension_table((folder / "none.csv").string()), InputError);
  EXPECT_THAT(fault(""), HasSubstr("t.csv"));
  EXPECT_THAT(fault(std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16)), HasSubstr("no text"));
  EXPECT_THAT(fault("PK\x03\x04 rest"), HasSubstr("save the sheet as CSV"));
  EXPECT_THAT(fault(std::string("\xFF\xFEh\0a\0", 6)), HasSubstr("UTF-16"));
  EXPECT_THAT(fault("\n\n\n"), HasSubstr("no header line"));
}

TEST(DimensionTable, PartsOfItAreChosenByConditionsAndGroups) {
  const population::DimensionTable table = parsed(
      "sex,age,site,hand_length_mm\nF,23,1,181\nM,31,2,193\nf,44,1,176\nM,29,1,201\n,52,2,188\n");
  EXPECT_EQ(population::where(table, "sex=F").subjects(), 2);
  EXPECT_EQ(population::where(table, "sex != F").subjects(), 2);  // the fifth is not known
  EXPECT_EQ(population::where(table, "age>=31").subjects(), 3);
  EXPECT_EQ(population::where(table, "site=1").subjects(), 3);
  EXPECT_EQ(population::where(population::where(table, "age<40"), "hand length>190").subjects(), 2);
  std::vector<std::string> notes;
  const auto ages = population::grouped(table, "age", notes);
  ASSERT_EQ(ages.size(), 4U);
  EXPECT_EQ(ages[0].name, "20-29");
  EXPECT_EQ(ages[0].table.subjects(), 2);
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_EQ(population::grouped(population::where(table, "sex=M"), "sex", notes).size(), 1U);
  population::grouped(table, "sex", notes);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("1 of 5 subjects have no sex")));
  for (const auto& [condition, why] :
       {std::pair{"sex", "not understood"}, std::pair{"sex~F", "not understood"},
        std::pair{"sex=X", "no subject"}, std::pair{"sex>F", "no numbers"},
        std::pair{"age=old", "is none"}, std::pair{"hand_lenght=1", "did you mean hand_length?"}}) {
    try {
      population::where(table, condition);
      ADD_FAILURE() << condition;
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr(why)) << condition;
    }
  }
}

// The hands of one or two people are a table too; statistics ask for more.
TEST(DimensionTable, OnePersonIsEnough) {
  const population::DimensionTable one = parsed("subject,hand_length_mm\nann,181\n");
  ASSERT_EQ(one.subjects(), 1);
  EXPECT_THAT(one.column("hand_length").values, ElementsAre(Optional(181.0)));
  EXPECT_EQ(one.column("subject").quantity, population::Quantity::kLabel);
  EXPECT_EQ(parsed("label,hand_length_mm\n1,181\n2,181\n").column("label").texts[1], "2");
}

TEST(DimensionTable, AHundredThousandColumnsAreRefusedAtOnce) {
  std::string text = "hand_length_mm";
  for (int i = 1; i < 100'000; ++i) text += ",c" + std::to_string(i);
  try {
    parsed(text + "\n");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("100000 columns; at most 10000 are allowed"));
  }
}

// ANSUR II's palm is 60 % of the hand, the template's 97.2 of 176.1 mm.
TEST(DimensionTable, APalmMeasuredBetweenOtherPointsIsReported) {
  EXPECT_THAT(parsed("hand_length_mm,palmlength_mm\n193,115\n181,109\n").notes,
              ElementsAre(AllOf(HasSubstr("column 2 (palmlength_mm)"), HasSubstr("59.9 %"),
                                HasSubstr("55.2 %"), HasSubstr("fingers too short"))));
  EXPECT_THAT(parsed("hand_length_mm,palmlength_mm\n193,106\n181,100\n").notes, IsEmpty());
  EXPECT_THAT(parsed("hand_length_mm,palmlength_mm\n193,\n181,NA\n").notes, IsEmpty());
}

TEST(DimensionTable, AnyBytesAreATableOrAnInputError) {
  const std::string base =
      "\xEF\xBB\xBFid;sex;Age [years];Hand length [mm];handbreadth (cm);\"odd; name\";grip_n\r\n"
      "a;F;23;181,5;8,1;x;310\r\nb;M;31;193;8,9;y;480\r\nc;F;44;176;NA;;.\r\nd;M;;201;9,2;z;5e2\n";
  std::mt19937 random(7);
  const std::string bits = "\";,.\t\n\r-+eE0159NAx[](){}_ \xC3\xFF";
  int tables = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string text = base;
    const int changes = 1 + static_cast<int>(random() % 6);
    for (int i = 0; i < changes && !text.empty(); ++i) {
      const std::size_t at = random() % text.size();
      const char c =
          random() % 8 == 0 ? static_cast<char>(random() % 256) : bits[random() % bits.size()];
      switch (random() % 4) {
        case 0:
          text[at] = c;
          break;
        case 1:
          text.insert(at, 1, c);
          break;
        case 2:
          text.erase(at, 1 + random() % 9);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), random() % 30));
      }
    }
    try {
      const population::DimensionTable table = parsed(text);
      ++tables;
      EXPECT_GE(table.subjects(), 1);
      for (const population::TableColumn& column : table.columns) {
        EXPECT_EQ(column.is_number ? column.values.size() : column.texts.size(),
                  table.lines.size());
      }
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("t.csv"));
    }
  }
  EXPECT_GT(tables, 1000);
}

}  // namespace
}  // namespace palmar::records
