// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_tables.h"

#include <sqlite3.h>
#include <zlib.h>

#include <algorithm>
#include <functional>
#include <set>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/population/sex_names.h"
#include "palmar/records/study/study_bytes.h"
#include "palmar/records/study/study_plan_json.h"
#include "palmar/records/study/study_store.h"
#include "palmar/study/assessment/grasp_indices.h"

namespace palmar::records {
namespace {

constexpr const char* kTables = R"sql(
CREATE TABLE study(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE input(kind TEXT NOT NULL, number INTEGER NOT NULL, data BLOB NOT NULL,
  PRIMARY KEY(kind, number));
CREATE TABLE population(population INTEGER PRIMARY KEY, name TEXT NOT NULL, title TEXT NOT NULL,
  source TEXT NOT NULL);
CREATE TABLE hand(hand INTEGER PRIMARY KEY, population INTEGER NOT NULL, label TEXT NOT NULL,
  stratum TEXT NOT NULL, sex TEXT, age_years REAL, grip_strength_n REAL);
CREATE TABLE hand_dimension(hand INTEGER NOT NULL, dimension TEXT NOT NULL, value_mm REAL NOT NULL,
  PRIMARY KEY(hand, dimension)) WITHOUT ROWID;
CREATE TABLE profile(profile INTEGER PRIMARY KEY, name TEXT NOT NULL);
CREATE TABLE setting(setting INTEGER PRIMARY KEY, name TEXT NOT NULL);
CREATE TABLE product(product INTEGER PRIMARY KEY, name TEXT NOT NULL, family TEXT NOT NULL,
  size REAL NOT NULL, file TEXT NOT NULL, content_sha256 TEXT NOT NULL);
CREATE TABLE asked_grip(grip INTEGER PRIMARY KEY, name TEXT NOT NULL);
CREATE TABLE quantity(quantity INTEGER PRIMARY KEY, key TEXT NOT NULL UNIQUE, name TEXT NOT NULL,
  unit TEXT NOT NULL, better TEXT NOT NULL, definition TEXT NOT NULL, source TEXT NOT NULL);
CREATE TABLE grasp(number INTEGER PRIMARY KEY, hand INTEGER NOT NULL, profile INTEGER NOT NULL,
  setting INTEGER NOT NULL, product INTEGER NOT NULL, asked_grip INTEGER NOT NULL,
  outcome TEXT NOT NULL, reason TEXT NOT NULL, grip TEXT NOT NULL, is_balanced INTEGER NOT NULL,
  force_n REAL NOT NULL, grip_force_n REAL NOT NULL, contact_area_mm2 REAL NOT NULL,
  peak_pressure_mpa REAL NOT NULL, peak_pressure_cells_mpa REAL NOT NULL,
  mean_pressure_mpa REAL NOT NULL, demand_range_share REAL NOT NULL,
  demand_grip_strength_n REAL NOT NULL, demand_nail_room_mm REAL NOT NULL,
  posture BLOB NOT NULL, product_from_hand BLOB NOT NULL, checksum INTEGER NOT NULL);
CREATE TABLE region(number INTEGER NOT NULL, region TEXT NOT NULL, force_n REAL NOT NULL,
  contact_area_mm2 REAL NOT NULL, peak_pressure_mpa REAL NOT NULL,
  peak_pressure_cells_mpa REAL NOT NULL, mean_pressure_mpa REAL NOT NULL,
  PRIMARY KEY(number, region)) WITHOUT ROWID;
CREATE TABLE grasp_index(number INTEGER NOT NULL, quantity INTEGER NOT NULL, value REAL NOT NULL,
  PRIMARY KEY(number, quantity)) WITHOUT ROWID;
CREATE TABLE hold(number INTEGER PRIMARY KEY, part INTEGER NOT NULL, part_name TEXT NOT NULL,
  part_kind TEXT NOT NULL, grip TEXT NOT NULL, along REAL NOT NULL, edge REAL NOT NULL,
  toward INTEGER NOT NULL, turn_rad REAL NOT NULL, over_end INTEGER NOT NULL, words TEXT NOT NULL);
CREATE TABLE fallback(number INTEGER NOT NULL, name TEXT NOT NULL, count INTEGER NOT NULL,
  PRIMARY KEY(number, name)) WITHOUT ROWID;
CREATE TABLE field(number INTEGER PRIMARY KEY, skin_pressure BLOB NOT NULL,
  product_pressure BLOB NOT NULL);
)sql";

constexpr const char* kTimings =
    "CREATE TABLE timing(number INTEGER PRIMARY KEY, seconds REAL NOT NULL);";

std::uint32_t checksum(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

std::optional<study::StudyOutcome> outcome_named(const std::string& name) {
  for (int i = 0; i <= static_cast<int>(study::StudyOutcome::kFailed); ++i) {
    if (name_of(static_cast<study::StudyOutcome>(i)) == name)
      return static_cast<study::StudyOutcome>(i);
  }
  return std::nullopt;
}

bool has_table(SqliteFile& file, const std::string& name) {
  return file.integer("SELECT count(*) FROM sqlite_schema WHERE name = '" + name + "'") > 0;
}

std::optional<product::PartKind> part_kind_named(const std::string& name) {
  for (const product::PartKind kind :
       {product::PartKind::kBar, product::PartKind::kPen, product::PartKind::kLoop,
        product::PartKind::kBody, product::PartKind::kBall, product::PartKind::kPlate}) {
    if (name_of(kind) == name) return kind;
  }
  return std::nullopt;
}

void insert_quantity(SqliteFile& file, std::int64_t id, const grasp::GraspIndex& row) {
  SqliteStatement(file, "INSERT INTO quantity VALUES(?,?,?,?,?,?,?)")
      .bind(1, id)
      .bind(2, std::string_view(row.key))
      .bind(3, std::string_view(row.name))
      .bind(4, std::string_view(row.unit))
      .bind(5, name_of(row.better))
      .bind(6, std::string_view(row.definition))
      .bind(7, std::string_view(row.source))
      .run();
}

void insert_hands(SqliteFile& file, const study::StudyPlan& plan) {
  SqliteStatement hand(file, "INSERT INTO hand VALUES(?,?,?,?,?,?,?)");
  SqliteStatement dimension(file, "INSERT INTO hand_dimension VALUES(?,?,?)");
  for (std::size_t h = 0; h < plan.hands.size(); ++h) {
    const population::HandSample& sample = plan.hands[h].sample;
    const auto number = static_cast<std::int64_t>(h);
    hand.bind(1, number)
        .bind(2, plan.hands[h].population)
        .bind(3, std::string_view(sample.label))
        .bind(4, std::string_view(sample.stratum));
    if (sample.sex) {
      hand.bind(5, population::name_of(*sample.sex));
    } else {
      hand.bind_null(5);
    }
    sample.age ? hand.bind(6, *sample.age) : hand.bind_null(6);
    sample.grip_strength > 0.0 ? hand.bind(7, sample.grip_strength) : hand.bind_null(7);
    hand.run();
    for (const hand::SizedDimension& one : sample.dimensions) {
      const std::string name = name_of(one.dimension);
      dimension.bind(1, number).bind(2, std::string_view(name)).bind(3, one.value).run();
    }
  }
}

/// The plan once more as tables, for people with other tools; Palmar reads its JSON.
void insert_plan(SqliteFile& file, const study::StudyPlan& plan) {
  const auto name_table = [&](const std::string& table, const auto& names) {
    SqliteStatement row(file, "INSERT INTO " + table + " VALUES(?,?)");
    for (std::size_t i = 0; i < names.size(); ++i) {
      row.bind(1, static_cast<std::int64_t>(i)).bind(2, std::string_view(names[i])).run();
    }
  };
  std::vector<std::string> profiles, settings, grips;
  for (const population::HandProfile& one : plan.profiles) profiles.push_back(one.name);
  for (const study::StudySetting& one : plan.settings) settings.push_back(one.name);
  for (const auto& one : plan.grips) grips.emplace_back(one ? name_of(*one) : "auto");
  name_table("profile", profiles);
  name_table("setting", settings);
  name_table("asked_grip", grips);
  SqliteStatement population(file, "INSERT INTO population VALUES(?,?,?,?)");
  for (std::size_t i = 0; i < plan.populations.size(); ++i) {
    const population::Population& one = plan.populations[i].population;
    population.bind(1, static_cast<std::int64_t>(i))
        .bind(2, std::string_view(one.name))
        .bind(3, std::string_view(one.title))
        .bind(4, std::string_view(one.source))
        .run();
  }
  SqliteStatement product(file, "INSERT INTO product VALUES(?,?,?,?,?,?)");
  for (std::size_t i = 0; i < plan.products.size(); ++i) {
    const study::StudyProduct& one = plan.products[i];
    product.bind(1, static_cast<std::int64_t>(i))
        .bind(2, std::string_view(one.name))
        .bind(3, std::string_view(one.family))
        .bind(4, one.size)
        .bind(5, std::string_view(one.file))
        .bind(6, std::string_view(one.content_hash))
        .run();
  }
  insert_hands(file, plan);
  const grasp::GraspIndices& catalogue = study::index_catalogue();
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    insert_quantity(file, static_cast<std::int64_t>(i), catalogue[i]);
  }
}

void insert_value(SqliteFile& file, const std::string& key, const std::string& value) {
  SqliteStatement(file, "INSERT INTO study VALUES(?,?)")
      .bind(1, std::string_view(key))
      .bind(2, std::string_view(value))
      .run();
}

}  // namespace

std::string study_value(SqliteFile& file, const std::string& key) {
  SqliteStatement statement(file, "SELECT value FROM study WHERE key = ?");
  statement.bind(1, std::string_view(key));
  return statement.next() ? statement.text(0) : "";
}

StudyTableWriter::StudyTableWriter(SqliteFile& file, const study::StudyPlan& plan)
    : file_(file),
      plan_(plan),
      grasp_(file, "INSERT INTO grasp VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)"),
      region_(file, "INSERT INTO region VALUES(?,?,?,?,?,?,?)"),
      index_(file, "INSERT INTO grasp_index VALUES(?,?,?)"),
      field_(file, "INSERT INTO field VALUES(?,?,?)") {
  // A study that an older program began goes on without.
  if (has_table(file, "hold"))
    hold_.emplace(file, "INSERT INTO hold VALUES(?,?,?,?,?,?,?,?,?,?,?)");
  if (has_table(file, "fallback")) fallback_.emplace(file, "INSERT INTO fallback VALUES(?,?,?)");
  SqliteStatement rows(file, "SELECT quantity, key FROM quantity");
  while (rows.next()) quantity_[rows.text(1)] = rows.integer(0);
}

std::int64_t StudyTableWriter::quantity_id(const std::string& key) {
  const auto found = quantity_.find(key);
  if (found != quantity_.end()) return found->second;
  std::int64_t id = 0;
  for (const auto& [known, number] : quantity_) id = std::max(id, number + 1);
  grasp::GraspIndex row;  // not in the catalogue: nothing more is known of it
  row.key = row.name = key;
  insert_quantity(file_, id, row);
  quantity_[key] = id;
  return id;
}

void StudyTableWriter::write(const study::StudyRecord& record) {
  write(record,
        {pack(field_bytes(record.skin_pressure)), pack(field_bytes(record.product_pressure))});
}

void StudyTableWriter::write(const study::StudyRecord& record, const PackedFields& packed) {
  // Keys that are not in the catalogue get their number by name within the first record that has
  // them, not by the order in which a record lists them.
  std::set<std::string> keys;
  for (const study::IndexRecord& index : record.indices) keys.insert(index.key);
  for (const std::string& key : keys) quantity_id(key);

  study::StudyRecord sorted = record;  // as a reader gives it back
  std::sort(sorted.indices.begin(), sorted.indices.end(),
            [this](const study::IndexRecord& a, const study::IndexRecord& b) {
              return quantity_id(a.key) < quantity_id(b.key);
            });
  const std::string bytes = record_bytes(sorted);
  const std::string skin = field_bytes(record.skin_pressure);
  const std::string product = field_bytes(record.product_pressure);
  for (const std::string* part : {&bytes, &skin, &product}) digest_.add(*part);

  const study::StudyTask task = study::task_at(plan_, record.number);
  grasp_.bind(1, record.number)
      .bind(2, task.hand)
      .bind(3, task.profile)
      .bind(4, task.setting)
      .bind(5, task.product)
      .bind(6, task.grip)
      .bind(7, name_of(record.outcome))
      .bind(8, record.reason)
      .bind(9, name_of(record.grip))
      .bind(10, record.is_balanced ? 1 : 0)
      .bind(11, record.force)
      .bind(12, record.grip_force)
      .bind(13, record.area)
      .bind(14, record.peak_pressure)
      .bind(15, record.peak_pressure_cells)
      .bind(16, record.mean_pressure)
      .bind(17, record.demand.range_share)
      .bind(18, record.demand.grip_strength)
      .bind(19, record.demand.nail_room)
      .bind_blob(20, posture_bytes(record.posture))
      .bind_blob(21, rigid_bytes(record.product_from_hand))
      .bind(22, static_cast<std::int64_t>(checksum(bytes)))
      .run();
  for (const study::RegionRecord& region : record.regions) {
    region_.bind(1, record.number)
        .bind(2, name_of(region.region))
        .bind(3, region.force)
        .bind(4, region.area)
        .bind(5, region.peak_pressure)
        .bind(6, region.peak_pressure_cells)
        .bind(7, region.mean_pressure)
        .run();
  }
  for (const study::IndexRecord& index : sorted.indices) {
    index_.bind(1, record.number).bind(2, quantity_id(index.key)).bind(3, index.value).run();
  }
  field_.bind(1, record.number).bind_blob(2, packed.skin).bind_blob(3, packed.product).run();
  if (record.hold && hold_) write_hold(record.number, *record.hold);
  if (fallback_) write_fallbacks(record.number, record.fallbacks);
}

/// Only what there is: most grasps have none.
void StudyTableWriter::write_fallbacks(std::int64_t number,
                                       const contact::ContactFallbacks& fallbacks) {
  for (const contact::FallbackCount& one : contact::kFallbackCounts) {
    const int count = fallbacks.*one.count;
    if (count == 0) continue;
    digest_.add(std::string(one.name) + " " + std::to_string(count));
    fallback_->bind(1, number).bind(2, one.name).bind(3, count).run();
  }
}

void StudyTableWriter::write_hold(std::int64_t number, const study::StudyHold& held) {
  const grasp::Hold& hold = held.hold;
  digest_.add(hold_bytes(held));
  hold_->bind(1, number)
      .bind(2, hold.part)
      .bind(3, std::string_view(hold.part_name))
      .bind(4, std::string_view(held.kind ? name_of(*held.kind) : ""))
      .bind(5, name_of(hold.grip))
      .bind(6, hold.along)
      .bind(7, hold.edge)
      .bind(8, hold.toward)
      .bind(9, hold.turn)
      .bind(10, hold.is_over_end ? 1 : 0)
      .bind(11, std::string_view(held.words))
      .run();
}

void StudyTableWriter::write_time(const study::StudyRecord& record) {
  SqliteStatement(file_, "INSERT INTO timing VALUES(?,?)")
      .bind(1, record.number)
      .bind(2, record.seconds)
      .run();
}

namespace {

std::string only_number(const std::string& column, std::optional<std::int64_t> only) {
  return only ? " WHERE " + column + " = " + std::to_string(*only) : "";
}

std::string grasp_query(bool with_fields, bool with_times, std::optional<std::int64_t> only) {
  std::string columns =
      "SELECT g.number, outcome, reason, grip, is_balanced, force_n, grip_force_n, "
      "contact_area_mm2, peak_pressure_mpa, peak_pressure_cells_mpa, mean_pressure_mpa, "
      "demand_range_share, demand_grip_strength_n, demand_nail_room_mm, posture, "
      "product_from_hand, checksum";
  std::string tables = " FROM grasp g";
  columns += with_times ? ", t.seconds" : ", 0";
  if (with_times) tables += " LEFT JOIN timing t ON t.number = g.number";
  if (with_fields) {
    columns += ", f.skin_pressure, f.product_pressure";
    tables += " LEFT JOIN field f ON f.number = g.number";
  }
  return columns + tables + only_number("g.number", only) + " ORDER BY g.number";
}

/// The oldest that holds it: what has no faces can be read by every Palmar.
int version_of(const StudyHead& head) {
  const bool has_faces = std::any_of(head.faces.begin(), head.faces.end(),
                                     [](const std::string& one) { return !one.empty(); });
  return has_faces ? kStudyStoreVersion : 1;
}

}  // namespace

StudyTableReader::StudyTableReader(SqliteFile& file, bool with_fields,
                                   std::optional<std::int64_t> only)
    : with_fields_(with_fields),
      grasp_(file, grasp_query(with_fields, has_table(file, "timing"), only)),
      region_(file,
              "SELECT number, region, force_n, contact_area_mm2, peak_pressure_mpa, "
              "peak_pressure_cells_mpa, mean_pressure_mpa FROM region" +
                  only_number("number", only) + " ORDER BY number, region"),
      index_(file, "SELECT number, quantity, value FROM grasp_index" + only_number("number", only) +
                       " ORDER BY number, quantity") {
  SqliteStatement rows(file, "SELECT quantity, key FROM quantity");
  while (rows.next()) quantity_[rows.integer(0)] = rows.text(1);
  has_region_ = region_.next();
  has_index_ = index_.next();
  // Studies of older programs have no such tables.
  if (has_table(file, "fallback")) {
    fallback_.emplace(file, "SELECT number, name, count FROM fallback" +
                                only_number("number", only) + " ORDER BY number");
    has_fallback_ = fallback_->next();
  }
  if (!has_table(file, "hold")) return;
  hold_.emplace(file,
                "SELECT number, part, part_name, part_kind, grip, along, edge, toward, turn_rad, "
                "over_end, words FROM hold" +
                    only_number("number", only) + " ORDER BY number");
  has_hold_ = hold_->next();
}

bool StudyTableReader::next(study::StudyRecord& record) {
  PackedFields fields;
  if (!next(record, fields)) return false;
  if (with_fields_) unpack_fields(fields, record);
  return true;
}

bool StudyTableReader::next(study::StudyRecord& record, PackedFields& fields) {
  if (!grasp_.next()) return false;
  record = {};
  record.number = grasp_.integer(0);
  const std::string what = "grasp " + std::to_string(record.number);
  const auto outcome = outcome_named(grasp_.text(1));
  const auto grip = grasp::grip_named(grasp_.text(3));
  if (!outcome || !grip) throw InputError(what + " is damaged");
  record.outcome = *outcome;
  record.reason = grasp_.text(2);
  record.grip = *grip;
  record.is_balanced = grasp_.integer(4) != 0;
  record.force = grasp_.number(5);
  record.grip_force = grasp_.number(6);
  record.area = grasp_.number(7);
  record.peak_pressure = grasp_.number(8);
  record.peak_pressure_cells = grasp_.number(9);
  record.mean_pressure = grasp_.number(10);
  record.demand = {grasp_.number(11), grasp_.number(12), grasp_.number(13)};
  record.seconds = grasp_.number(17);
  try {
    record.posture = posture_from_bytes(grasp_.blob(14));
    record.product_from_hand = rigid_from_bytes(grasp_.blob(15));
  } catch (const InputError& error) {
    throw InputError(what + ": " + error.what());
  }
  if (with_fields_) fields = {grasp_.blob(18), grasp_.blob(19)};
  read_regions(record);
  read_indices(record);
  read_hold(record);
  read_fallbacks(record);
  if (checksum(record_bytes(record)) != static_cast<std::uint32_t>(grasp_.integer(16))) {
    throw InputError(what + " is damaged: its values don't have the checksum they were kept with");
  }
  return true;
}

void unpack_fields(const PackedFields& fields, study::StudyRecord& record) {
  try {
    record.skin_pressure = field_from_bytes(unpack(fields.skin));
    record.product_pressure = field_from_bytes(unpack(fields.product));
  } catch (const InputError& error) {
    throw InputError("grasp " + std::to_string(record.number) + ": " + error.what());
  }
}

void StudyTableReader::read_regions(study::StudyRecord& record) {
  while (has_region_ && region_.integer(0) <= record.number) {
    const auto region = hand::region_named(region_.text(1));
    if (!region || region_.integer(0) < record.number) {
      throw InputError("grasp " + std::to_string(record.number) + ": its regions are damaged");
    }
    record.regions.push_back({.region = *region,
                              .force = region_.number(2),
                              .area = region_.number(3),
                              .peak_pressure = region_.number(4),
                              .peak_pressure_cells = region_.number(5),
                              .mean_pressure = region_.number(6)});
    has_region_ = region_.next();
  }
  std::sort(record.regions.begin(), record.regions.end(),
            [](const study::RegionRecord& a, const study::RegionRecord& b) {
              return a.region < b.region;
            });
}

void StudyTableReader::read_indices(study::StudyRecord& record) {
  while (has_index_ && index_.integer(0) <= record.number) {
    const auto key = quantity_.find(index_.integer(1));
    if (key == quantity_.end() || index_.integer(0) < record.number) {
      throw InputError("grasp " + std::to_string(record.number) + ": its indices are damaged");
    }
    record.indices.push_back({key->second, index_.number(2)});
    has_index_ = index_.next();
  }
}

void StudyTableReader::read_hold(study::StudyRecord& record) {
  if (!hold_) return;
  while (has_hold_ && hold_->integer(0) < record.number) has_hold_ = hold_->next();
  if (!has_hold_ || hold_->integer(0) != record.number) return;
  study::StudyHold held;
  const auto grip = grasp::grip_named(hold_->text(4));
  if (!grip) throw InputError("grasp " + std::to_string(record.number) + ": its hold is damaged");
  held.hold.part = static_cast<int>(hold_->integer(1));
  held.hold.part_name = hold_->text(2);
  held.kind = part_kind_named(hold_->text(3));
  held.hold.grip = *grip;
  held.hold.along = hold_->number(5);
  held.hold.edge = hold_->number(6);
  held.hold.toward = static_cast<int>(hold_->integer(7));
  held.hold.turn = hold_->number(8);
  held.hold.is_over_end = hold_->integer(9) != 0;
  held.words = hold_->text(10);
  record.hold = std::move(held);
  has_hold_ = hold_->next();
}

void StudyTableReader::read_fallbacks(study::StudyRecord& record) {
  while (has_fallback_ && fallback_->integer(0) <= record.number) {
    const std::string name = fallback_->text(1);
    for (const contact::FallbackCount& one : contact::kFallbackCounts) {
      if (name != one.name || fallback_->integer(0) < record.number) continue;
      record.fallbacks.*one.count = static_cast<int>(fallback_->integer(2));
    }
    has_fallback_ = fallback_->next();
  }
}

void build_store(const std::filesystem::path& path, const StudyHead& head, bool is_finished,
                 const std::function<void(StudyTableWriter&)>& fill) {
  SqliteFile file(path.string(), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  // Nothing to roll back to and nobody else there: the file counts once it is complete and renamed.
  // secure_delete: freed bytes become 0, not what stood there.
  file.run("PRAGMA page_size = " + std::to_string(kStudyPageSize) +
           "; PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; PRAGMA secure_delete = ON;"
           "PRAGMA locking_mode = EXCLUSIVE; PRAGMA application_id = " +
           std::to_string(kStudyApplicationId) +
           "; PRAGMA user_version = " + std::to_string(version_of(head)) + "; BEGIN EXCLUSIVE");
  file.run(kTables);
  if (!is_finished) file.run(kTimings);
  const std::string plan = format_plan(head.plan);
  insert_value(file, "palmar", head.program);
  insert_value(file, "plan", plan);
  insert_value(file, "shard", name_of(head.shard));
  SqliteStatement input(file, "INSERT INTO input VALUES(?,?,?)");
  input.bind(1, "hand").bind(2, 0).bind_blob(3, head.hand).run();
  for (std::size_t i = 0; i < head.products.size(); ++i) {
    input.bind(1, "product")
        .bind(2, static_cast<std::int64_t>(i))
        .bind_blob(3, head.products[i])
        .run();
  }
  for (std::size_t i = 0; i < head.faces.size(); ++i) {
    if (head.faces[i].empty()) continue;
    input.bind(1, "faces").bind(2, static_cast<std::int64_t>(i)).bind_blob(3, head.faces[i]).run();
  }
  insert_plan(file, head.plan);
  {
    StudyTableWriter writer(file, head.plan);
    for (const std::string& part :
         {head.program, format_identity(head.plan), name_of(head.shard)}) {
      writer.add_to_digest(part);
      writer.add_to_digest("\n");
    }
    if (fill) fill(writer);
    if (is_finished) insert_value(file, "digest", writer.digest());
  }
  file.run("COMMIT");
}

}  // namespace palmar::records
