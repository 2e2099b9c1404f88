// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/workbook.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/formats/zip.h"

namespace palmar::records {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string part(const std::string& workbook, const std::string& name) {
  return formats::ZipArchive(workbook, "made.xlsx").read(name).value_or("missing " + name);
}

WorkbookSheet regions() {
  return {"regions",
          "One region of the hand.",
          {{"product", "force_n", "contact_area_mm2", "hands"},
           {{"<A & \"B\">", "12.3456789012345", "450.5", "6"}, {"007", "nan", "", "1e3"}}}};
}

TEST(Workbook, NumbersStayInFullDigitsAndTextIsText) {
  const std::string sheet = part(format_workbook("T", {}, {regions()}), "xl/worksheets/sheet2.xml");
  EXPECT_THAT(sheet, HasSubstr("<v>12.3456789012345</v>"));
  EXPECT_THAT(sheet, HasSubstr("&lt;A &amp; &quot;B&quot;&gt;"));
  EXPECT_THAT(sheet, HasSubstr(">007<"));  // an article's number keeps its zeros
  EXPECT_THAT(sheet, HasSubstr(">nan</t>"));
  EXPECT_THAT(sheet, HasSubstr("force [N]"));
  EXPECT_THAT(sheet, HasSubstr("contact area [mm²]"));
  EXPECT_THAT(sheet, Not(HasSubstr("r=\"C3\"")));  // nothing there
  EXPECT_THAT(sheet, HasSubstr("<autoFilter ref=\"A1:D3\"/>"));
}

TEST(Workbook, TheFirstSheetSaysWhatIsThere) {
  const std::string book = format_workbook("Two handles", {"Made by Palmar."}, {regions()});
  const std::string about = part(book, "xl/worksheets/sheet1.xml");
  for (const char* const words :
       {"Two handles", "Made by Palmar.", "One region of the hand.", "contact_area_mm2", "mm²"}) {
    EXPECT_THAT(about, HasSubstr(words)) << words;
  }
}

TEST(Workbook, NamesOfTabsAreAllowedAndDifferent) {
  WorkbookSheet one = regions();
  one.name = "a/b: all the regions of all the hands of the study";
  const std::string book = part(format_workbook("T", {}, {one, one}), "xl/workbook.xml");
  EXPECT_THAT(book, HasSubstr("name=\"ab all the regions of all the h\""));
  EXPECT_THAT(book, HasSubstr("name=\"ab all the regions of all the 2\""));
}

TEST(Workbook, ColumnsAreInWords) {
  EXPECT_EQ(words_of_column("peak_pressure_cells_mpa").words, "peak pressure cells");
  EXPECT_EQ(words_of_column("peak_pressure_cells_mpa").unit, "MPa");
  EXPECT_EQ(words_of_column("moment_n_mm").unit, "N mm");
  EXPECT_EQ(words_of_column("hands").unit, "");
}

TEST(Workbook, AnotherProgramReadsIt) {
  if (std::system("python3 -c 'import openpyxl' > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "Python's openpyxl (Debian: python3-openpyxl) isn't installed";
  }
  const formats::TestFolder folder;
  formats::write_file(folder / "made.xlsx", format_workbook("T", {}, {regions()}));
  std::ofstream(folder / "read.py")
      << "import openpyxl, sys\n"
         "b = openpyxl.load_workbook(sys.argv[1])\n"
         "s = b['regions']\n"
         "print(b.sheetnames, s['A2'].value, s['B2'].value, s['B2'].number_format, s['C3'].value,\n"
         "      s['D3'].value, s.freeze_panes, s.auto_filter.ref, s['A1'].font.bold)\n";
  const std::string out = (folder / "out.txt").string();
  ASSERT_EQ(std::system(("python3 '" + (folder / "read.py").string() + "' '" +
                         (folder / "made.xlsx").string() + "' > '" + out + "' 2>&1")
                            .c_str()),
            0)
      << formats::read_file(out);
  EXPECT_EQ(formats::read_file(out),
            "['About', 'regions'] <A & \"B\"> 12.3456789012345 0.0 None 1000.0 A2 A1:D3 True\n");
}

TEST(Workbook, RefusesWhatItCannotHold) {
  EXPECT_THROW(format_workbook("T", {}, {}), UsageError);
  WorkbookSheet broken = regions();
  broken.table.rows[0].pop_back();
  try {
    format_workbook("T", {}, {broken});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "workbook: a row of sheet \"regions\" has 3 cells, its header 4");
  }
}

TEST(RoundedTable, ShortensWhatIsNotWhole) {
  const CsvTable table = rounded_table({{"a"},
                                        {{"12.3456"},
                                         {"1234.56"},
                                         {"0.00123456"},
                                         {"-0.5"},
                                         {"30"},
                                         {"name 1.2345"},
                                         {""},
                                         {"9.996"}}});
  const std::vector<std::string> expected = {"12.3", "1235",        "0.00123", "-0.500",
                                             "30",   "name 1.2345", "",        "10.00"};
  for (std::size_t r = 0; r < expected.size(); ++r) EXPECT_EQ(table.rows[r][0], expected[r]);
  EXPECT_THROW(rounded_table({}, 0), UsageError);
}

}  // namespace
}  // namespace palmar::records
