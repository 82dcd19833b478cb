#include "data/run_table.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/atomic_file.hpp"
#include "data/hdf5.hpp"
#include "data/random.hpp"
#include "tests/temporary.hpp"

namespace {

data::Study study_of(const TemporaryFolder& folder, const std::string& more = "") {
  const std::string text =
      "[parameters.friction]\nlow = 0.1\nhigh = 0.8\n[parameters.cohesion]\nunit = \"mJ/m2\"\nlow = 0\nhigh = 10\n"
      "[controls.speed]\nunit = \"rpm\"\nlow = 50\nhigh = 300\n[controls.warmth]\nunit = \"degC\"\nlow = 10\nhigh = "
      "30\n"
      "[training]\ntable = \"runs.csv\"\n[outputs.torque]\nunit = \"mN m\"\n";
  const data::StudyFile file = data::StudyFile::open(folder.write("study.toml", text + more));
  data::Study study = data::read_study(file);
  return study;
}

data::RunTable random_table(const data::Study& study, std::size_t rows) {
  data::RandomStream random(3, data::Purpose::test);
  data::RunTable table = data::empty_table(study);
  for (std::size_t i = 0; i < rows; ++i) {
    data::RunRow row;
    row.material = study.materials.front().name;
    row.inputs = {random.uniform(0.1, 0.8), random.uniform(0.0, 0.01), random.uniform(5.0, 31.0),
                  random.uniform(283.0, 303.0)};
    row.outputs = {random.uniform(0.001, 0.02)};
    row.standard_errors = {random.uniform(1e-5, 1e-4)};
    row.seed = random();
    row.settings = "0123abcd";
    row.isa = "x86-64-v3";
    row.origin = "demcal 0.1.0, \"quoted\"";
    row.cpu_seconds = random.uniform(1.0, 30.0);
    row.state = i % 3 == 0 ? "" : i % 3 == 1 ? "steady" : "drifting";
    row.unreliable = i % 2 == 0 ? "" : "torque_fluctuation axial_flow";
    table.rows.push_back(row);
  }
  return table;
}

void check_same(const data::RunTable& a, const data::RunTable& b) {
  REQUIRE(a.rows.size() == b.rows.size());
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    CHECK(a.rows[i].material == b.rows[i].material);
    CHECK(a.rows[i].inputs == b.rows[i].inputs);
    CHECK(a.rows[i].outputs == b.rows[i].outputs);
    CHECK(a.rows[i].standard_errors == b.rows[i].standard_errors);
    CHECK(a.rows[i].seed == b.rows[i].seed);
    CHECK(a.rows[i].settings == b.rows[i].settings);
    CHECK(a.rows[i].isa == b.rows[i].isa);
    CHECK(a.rows[i].origin == b.rows[i].origin);
    CHECK(a.rows[i].cpu_seconds == b.rows[i].cpu_seconds);
    CHECK(a.rows[i].state == b.rows[i].state);
    CHECK(a.rows[i].unreliable == b.rows[i].unreliable);
  }
}

const std::string header = "friction,cohesion,speed,warmth,torque,torque_se";

}  // namespace

TEST_CASE("a table comes back from CSV and from HDF5 with the same bits, through units with factor and offset") {
  const TemporaryFolder folder;
  const data::Study study = study_of(folder, "[materials.\"z 8,00\"]\n");
  const data::RunTable table = random_table(study, 300);
  data::write_table_csv(folder.path("t.csv"), table, study);
  const data::TableRead csv = data::read_table(folder.path("t.csv"), study);
  check_same(table, csv.table);
  CHECK(csv.left_out.empty());
  data::write_table_hdf5(folder.path("t.h5"), table, study);
  check_same(table, data::read_table(folder.path("t.h5"), study).table);
}

TEST_CASE("an empty table and one whose columns stand in another order are read") {
  const TemporaryFolder folder;
  const data::Study study = study_of(folder);
  data::write_table_hdf5(folder.path("t.h5"), data::empty_table(study), study);
  CHECK(data::read_table(folder.path("t.h5"), study).table.rows.empty());
  const auto path =
      folder.write("t.csv", "torque_se,note,torque,warmth,speed,friction,cohesion\n0.1,x,8,20,60,0.4,4\n");
  const data::RunRow row = data::read_table(path, study).table.rows.at(0);
  CHECK(row.inputs[1] == Approx(0.004));
  CHECK(row.inputs[3] == Approx(293.15));
  CHECK(row.outputs[0] == Approx(0.008));
  CHECK(row.origin == "t.csv:2");
}

TEST_CASE("a table of another code without standard errors is read with none, and that is noted") {
  const TemporaryFolder folder;
  const data::Study study = study_of(folder);
  const auto path = folder.write("t.csv", "friction,cohesion,speed,warmth,torque\n0.4,4,60,20,8\n0.5,4,60,20,9\n");
  const data::TableRead read = data::read_table(path, study);
  REQUIRE(read.table.rows.size() == 2);
  CHECK(read.table.rows[1].outputs[0] == Approx(0.009));
  CHECK(read.table.rows[1].standard_errors[0] == 0.0);
  REQUIRE(read.findings.size() == 1);
  CHECK(read.findings[0].severity == data::Severity::note);
  CHECK(read.findings[0].what == "has no torque_se: the runs' scatter is estimated");
  // So is a column of it that an exporter left empty.
  const auto blank =
      folder.write("blank.csv", "friction,cohesion,speed,warmth,torque,torque_se\n0.4,4,60,20,8,\n0.5,4,60,20,9, \n");
  const data::TableRead empty = data::read_table(blank, study);
  REQUIRE(empty.table.rows.size() == 2);
  CHECK(empty.table.rows[1].outputs[0] == Approx(0.009));
  CHECK(empty.table.rows[1].standard_errors[0] == 0.0);
  // What may be a standard deviation is not taken for a standard error, and that is said.
  const auto errors = [&](const char* name) {
    return data::read_table(
        folder.write("e.csv", std::string("friction,cohesion,speed,warmth,torque,") + name + "\n0.4,4,60,20,8,1\n"),
        study);
  };
  for (const char* name : {"torque_sd", "torque_std", "torque_Error"}) {
    const data::TableRead doubtful = errors(name);
    CHECK(doubtful.table.rows[0].standard_errors[0] == 0.0);
    CHECK_THAT(doubtful.findings[0].what, Catch::Contains(std::string(name) + " may be standard deviations"));
  }
  for (const char* name : {"torque_se", "torque_SEM", "torque_stderr"})
    CHECK(errors(name).table.rows[0].standard_errors[0] == Approx(0.001));
}

TEST_CASE("rows with NaN or an empty cell are left out and named") {
  const TemporaryFolder folder;
  const data::Study study = study_of(folder);
  const auto path = folder.write("t.csv", header + "\n0.4,4,60,20,nan,0.1\n0.4,4,60,20,8,0.1\n0.4,,60,20,8,0.1\n");
  const data::TableRead read = data::read_table(path, study);
  CHECK(read.table.rows.size() == 1);
  REQUIRE(read.left_out.size() == 2);
  CHECK(read.left_out[0].find("t.csv:2: torque: is nan, the row is left out") != std::string::npos);
  CHECK(read.left_out[1].find("t.csv:4: cohesion: is empty, the row is left out") != std::string::npos);
}

TEST_CASE("a row that lacks one of several outputs is kept for the others, through either file") {
  const TemporaryFolder folder;
  data::Study study = study_of(folder);
  study.outputs.push_back({.name = "flow", .unit = data::parse_unit("g/s"), .place = {}});
  const auto path = folder.write("t.csv", header + ",flow,flow_se\n0.4,4,60,20,nan,0.1,3,0.2\n0.4,4,60,20,8,0.1,3,\n" +
                                              "0.4,4,60,20,8,0.1,3,0.2\n0.4,4,60,20,,,nan,nan\n");
  const data::TableRead read = data::read_table(path, study);
  REQUIRE(read.table.rows.size() == 3);
  CHECK(std::isnan(read.table.rows[0].outputs[0]));
  CHECK(read.table.rows[0].outputs[1] == Approx(3e-3));
  CHECK(std::isnan(read.table.rows[1].outputs[1]));
  REQUIRE(read.left_out.size() == 3);
  CHECK(read.left_out[0].find("t.csv:2: torque: is nan, the row counts for the other outputs only") !=
        std::string::npos);
  CHECK(read.left_out[1].find("t.csv:3: flow_se: is empty") != std::string::npos);
  CHECK(read.left_out[2].find("t.csv:5") != std::string::npos);

  const std::string again = folder.write("again.csv", ""), stored = folder.write("again.h5", "");
  data::write_table_csv(again, read.table, study);
  data::write_table_hdf5(stored, read.table, study);
  for (const std::string& file : {again, stored}) {
    const data::RunTable back = data::read_table(file, study).table;
    REQUIRE(back.rows.size() == 3);
    CHECK(std::isnan(back.rows[0].outputs[0]));
    CHECK(back.rows[0].outputs[1] == read.table.rows[0].outputs[1]);
    CHECK(back.rows[2].outputs == read.table.rows[2].outputs);
  }
}

TEST_CASE("a run of ours without any mean stays in the table, through either file") {
  const TemporaryFolder folder;
  const data::Study study = study_of(folder);
  data::RunTable table = random_table(study, 3);
  table.rows[1].outputs = table.rows[1].standard_errors = {std::nan("")};
  data::write_table_csv(folder.path("t.csv"), table, study);
  data::write_table_hdf5(folder.path("t.h5"), table, study);
  for (const char* name : {"t.csv", "t.h5"}) {
    const data::RunTable back = data::read_table(folder.path(name), study).table;
    REQUIRE(back.rows.size() == 3);
    CHECK(std::isnan(back.rows[1].outputs[0]));
    CHECK(back.rows[1].seed == table.rows[1].seed);
    CHECK(back.rows[2].outputs == table.rows[2].outputs);
  }
}

TEST_CASE(
    "an output that leaves the study stays in its table, and one that comes to it is lacked, through either file") {
  const TemporaryFolder folder;
  const data::Study both = study_of(folder, "[outputs.angle]\nunit = \"deg\"\n"), one = study_of(folder);
  data::RunTable table = random_table(one, 5);
  for (data::RunRow& row : table.rows) {
    row.unreliable.clear();
    row.outputs.push_back(0.5 + row.outputs[0]);
    row.standard_errors.push_back(0.01);
  }
  table.outputs = data::empty_table(both).outputs;
  for (const char* name : {"t.h5", "t.csv"}) {
    const std::string path = folder.path(name);
    const auto write = [&](const data::RunTable& rows, const data::Study& study) {
      path.ends_with(".h5") ? data::write_table_hdf5(path, rows, study) : data::write_table_csv(path, rows, study);
    };
    write(table, both);
    data::RunTable narrow = data::read_table(path, one).table;
    REQUIRE(narrow.others.size() == 1);
    CHECK(narrow.others[0].name == "angle");
    data::RunRow added = random_table(one, 6).rows.back();  // a run made while there was no such output
    added.unreliable.clear();
    narrow.rows.push_back(added);
    write(data::merge(data::empty_table(one), narrow), one);

    const data::RunTable wide = data::read_table(path, both).table;
    REQUIRE(wide.rows.size() == 6);
    for (std::size_t i = 0; i < 5; ++i) {
      CHECK(wide.rows[i].outputs == table.rows[i].outputs);
      CHECK(wide.rows[i].standard_errors == table.rows[i].standard_errors);
      CHECK_FALSE(data::lacks_output(wide, wide.rows[i]));
    }
    CHECK(data::lacks_output(wide, wide.rows[5]));
    CHECK(wide.rows[5].outputs[0] == added.outputs[0]);
    CHECK(std::isnan(wide.rows[5].outputs[1]));

    write(narrow, one);
    data::RunTable never = data::read_table(path, one).table;
    never.others.clear();
    write(never, one);  // as tables were before the output came
    const data::TableRead lacking = data::read_table(path, both);
    REQUIRE(lacking.table.rows.size() == 6);
    for (const data::RunRow& row : lacking.table.rows) CHECK(data::lacks_output(lacking.table, row));
  }
  // What somebody wrote beside our columns in a unit of their own is passed over as before.
  data::write_table_csv(folder.path("own.csv"), table, both);
  std::string text = data::read_file(folder.path("own.csv"));
  const std::size_t unit = text.find("angle [") + 7;
  text.replace(unit, text.find("]", unit) - unit, "qqq");
  const data::TableRead own = data::read_table(folder.write("edited.csv", text), one);
  CHECK(own.table.rows.size() == 5);
  CHECK(own.table.others.empty());
  data::RunRow unknown = table.rows[0];
  unknown.outputs[1] = std::nan("");
  unknown.unreliable = "angle:short";
  CHECK_FALSE(data::lacks_output(table, unknown));
}

TEST_CASE("rows of which the same is said share one line where they are many") {
  const TemporaryFolder folder;
  const data::Study study = study_of(folder);
  std::string rows = header + "\n0.4,4,60,20,8,0.1\n";
  for (int i = 0; i < 500; ++i) rows += "0.4,4,60,20,,0.1\n";
  const data::TableRead read = data::read_table(folder.write("t.csv", rows + "0.4,,60,20,8,0.1\n"), study);
  CHECK(read.table.rows.size() == 1);
  REQUIRE(read.left_out.size() == 2);
  CHECK(read.left_out[0].find("t.csv:3, 4, 5") != std::string::npos);
  CHECK(read.left_out[0].find("more: torque: is empty, the rows are left out") != std::string::npos);
  CHECK(read.left_out[1].find("t.csv:503: cohesion: is empty, the row is left out") != std::string::npos);
}

TEST_CASE("what is wrong with a table in CSV is named with line and column") {
  const TemporaryFolder folder;
  const data::Study study = study_of(folder);
  const auto failure = [&](const std::string& text) {
    return failure_of(folder, [&] { data::read_table(folder.write("t.csv", text), study); });
  };
  CHECK(failure("friction,speed,warmth,torque,torque_se\n") ==
        "65: t.csv:1: the column 'cohesion' is missing (the columns are friction, speed, warmth, torque, torque_se)");
  CHECK(failure(header + "\n0.4,4,fast,20,8,0.1\n") ==
        "65: t.csv:2: speed: 'fast' is not a number (write a plain number with a decimal point)");
  CHECK(failure(header + "\n0.4,4,60,20,8,-0.1\n").find("65: t.csv:2: torque_se: -0.1 is below 0") == 0);
  CHECK(failure(header + ",material\n0.4,4,60,20,8,0.1,sand\n")
            .find("65: t.csv:2: material: 'sand' is not a material of the study") == 0);
  CHECK(failure_of(folder, [&] {
          data::read_table(folder.path("none.csv"), study);
        }).find("66: none.csv: there is no such file") == 0);
}

TEST_CASE("a table that was cut off anywhere is refused with its place") {
  const TemporaryFolder folder;
  const data::Study study = study_of(folder);
  const data::RunTable table = random_table(study, 40);
  data::write_table_csv(folder.path("t.csv"), table, study);
  data::write_table_hdf5(folder.path("t.h5"), table, study);
  for (const std::string name : {"t.csv", "t.h5"}) {
    const std::string whole = folder.read(name);
    for (std::size_t kept = 0; kept < whole.size(); kept += name == "t.csv" ? 37 : 501) {
      folder.write(name, whole.substr(0, kept));
      const std::string found = failure_of(folder, [&] { data::read_table(folder.path(name), study); });
      INFO(kept << " of " << whole.size() << ": " << found);
      CHECK(found.find("65: " + name) == 0);
      CHECK(found.find('\n') == std::string::npos);
    }
    for (const std::size_t missing : {1, 2}) {
      folder.write(name, whole.substr(0, whole.size() - missing));
      CHECK(failure_of(folder, [&] { data::read_table(folder.path(name), study); }).find("65: " + name) == 0);
    }
  }
}

TEST_CASE("an HDF5 table that is unfinished, short of values or of another study is refused with its place") {
  const TemporaryFolder folder;
  const data::Study study = study_of(folder);
  const std::string path = folder.path("t.h5");
  const auto failure = [&] { return failure_of(folder, [&] { data::read_table(path, study); }); };
  data::write_table_hdf5(path, random_table(study, 5), study);
  data::open_hdf5_to_write(path).set("complete", std::int64_t{0});
  CHECK(failure().find("65: t.h5: is not marked complete") == 0);
  data::open_hdf5_to_write(path).set("complete", std::int64_t{1});
  data::open_hdf5_to_write(path).set("rows", std::int64_t{6});
  CHECK(failure().find("65: t.h5: /runs/seed: holds 5 values where the table has 6 rows") == 0);
  data::open_hdf5_to_write(path).set("rows", std::int64_t{5});
  data::open_hdf5_to_write(path).group("parameters").set("SI unit", "m", "friction");
  CHECK(failure().find("65: t.h5: /parameters/friction: is in 'm' where the study measures '1'") == 0);
  data::open_hdf5_to_write(path).group("parameters").set("SI unit", "1", "friction");
  data::open_hdf5_to_write(path).group("parameters").write("stiffness", std::vector<double>(5));
  CHECK(failure().find("65: t.h5: /parameters/stiffness: is a parameter that the study does not have") == 0);
  data::write_table_hdf5(path, random_table(study, 5), study);
  data::Study more = study;
  more.parameters.push_back(study.parameters.front());
  more.parameters.back().name = "stiffness";
  CHECK(failure_of(folder, [&] {
          data::read_table(path, more);
        }).find("65: t.h5: /parameters: has no 'stiffness', a parameter that came to the study after these runs") == 0);
  data::create_hdf5(path).set("format", "something else");
  CHECK(failure().find("65: t.h5: is not a run table of demcal") == 0);
}

TEST_CASE("the other-code table reads whole") {
  const data::StudyFile file = data::StudyFile::open(DEMCAL_SOURCE_DIR "/data/other-code");
  const data::Study study = data::read_study(file);
  const data::TableRead read = data::read_table(study.training.table, study);
  CHECK(read.table.rows.size() == 80);
  CHECK(read.left_out.empty());
  for (const data::RunRow& row : read.table.rows) {
    CHECK(row.inputs[0] >= study.parameters[0].low);
    CHECK(row.inputs[2] <= study.controls[0].high * (1.0 + 1e-12));
    CHECK(row.standard_errors[0] / row.outputs[0] == Approx(0.01).epsilon(0.05));
  }
}

TEST_CASE("merging keeps what is there and adds only new points") {
  const TemporaryFolder folder;
  const data::Study study = study_of(folder);
  const data::RunTable table = random_table(study, 4);
  data::RunTable other = table;
  other.rows[1].seed += 1;           // a replicate
  other.rows[2].settings = "other";  // another time step
  other.rows[3].inputs[0] += 1e-15;  // the same point to 12 digits
  other.rows[0].outputs[0] = 1.0;    // the same run
  const data::RunTable merged = data::merge(table, other);
  CHECK(merged.rows.size() == 6);
  CHECK(merged.rows[0].outputs == table.rows[0].outputs);
  CHECK(data::merge(merged, other).rows.size() == 6);
  CHECK(data::merge(data::empty_table(study), table).rows.size() == 4);
}

TEST_CASE("another code's replicates of one point are all kept") {
  const TemporaryFolder folder;
  const data::Study study = study_of(folder);
  const auto path = folder.write("t.csv", header + "\n0.4,4,60,20,8,0.1\n0.4,4,60,20,8.2,0.1\n");
  const data::RunTable shipped = data::read_table(path, study).table;
  const data::RunTable merged = data::merge(data::empty_table(study), shipped);
  CHECK(merged.rows.size() == 2);
  CHECK(data::merge(merged, shipped).rows.size() == 2);
}

TEST_CASE("the key of a row tells material, point, seed and settings apart, and not the sign of zero") {
  data::RunRow row;
  row.inputs = {0.4, 0.0};
  data::RunRow same = row;
  same.inputs[1] = -0.0;
  same.outputs = {3.0};
  CHECK(data::row_key(row) == data::row_key(same));
  same.material = "carrier";
  CHECK(data::row_key(row) != data::row_key(same));
}

TEST_CASE("an output whose error is not known is dropped from its row by its whole name, and said") {
  data::RunTable table;
  table.outputs = {{"torque", {}}, {"torque_fluctuation", {}}};
  data::RunRow row;
  row.outputs = {1.0, 2.0};
  row.standard_errors = {0.1, 0.2};
  table.rows = {row, row};
  table.rows[1].unreliable = "coordination torque_fluctuation";
  const std::vector<std::string> notes = data::drop_unreliable(table, true);
  CHECK(table.rows[0].outputs[1] == 2.0);
  CHECK(table.rows[1].outputs[0] == 1.0);
  CHECK(std::isnan(table.rows[1].outputs[1]));
  CHECK(std::isnan(table.rows[1].standard_errors[1]));
  REQUIRE(notes.size() == 1);
  CHECK_THAT(notes[0], Catch::Contains("1 of 2 runs") && Catch::Contains("torque_fluctuation"));
}

TEST_CASE("an output of a run too short to know its error counts where the scatter of the runs is estimated") {
  data::RunTable table;
  table.outputs = {{"torque", {}}, {"torque_fluctuation", {}}};
  table.rows = {{.outputs = {1.0, 2.0}, .standard_errors = {0.1, 0.2}, .unreliable = "torque_fluctuation:short"}};
  data::RunTable without = table;
  const std::vector<std::string> kept = data::drop_unreliable(table, true),
                                 gone = data::drop_unreliable(without, false);
  CHECK(table.rows[0].outputs[1] == 2.0);
  CHECK(table.rows[0].standard_errors[1] == 0.2);
  CHECK(std::isnan(without.rows[0].outputs[1]));
  CHECK(without.rows[0].outputs[0] == 1.0);
  REQUIRE(kept.size() == 1);
  REQUIRE(gone.size() == 1);
  CHECK_THAT(kept[0], Catch::Contains("the surrogate estimates the rest"));
  CHECK_THAT(gone[0], Catch::Contains("count for the other outputs"));
}

TEST_CASE("a row is unsteady where it says so, and not where nobody looked") {
  data::RunRow row;
  CHECK_FALSE(data::is_unsteady(row));
  row.state = "steady";
  CHECK_FALSE(data::is_unsteady(row));
  row.state = "drifting";
  CHECK(data::is_unsteady(row));
  row.state = "short";
  CHECK(data::is_unsteady(row));
}
