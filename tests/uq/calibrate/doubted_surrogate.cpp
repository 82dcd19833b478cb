// A misfit under a surrogate that is in doubt. The runs move one input at a time, so that how the effect of one depends on
// another is assumed. The readings are those of the true function, with which they fit: chi-squared 4.2 for five.
#include <catch2/catch.hpp>

#include "data/study_file.hpp"
#include "tests/temporary.hpp"
#include "uq/calibrate/calibrate.hpp"

namespace {

const char* const study_text =
    "[study]\nname = \"star\"\nseed = 5\n"
    "[parameters.friction]\nlow = 0.1\nhigh = 0.8\n"
    "[parameters.cohesion]\nunit = \"mJ/m2\"\nlow = 0\nhigh = 10\n"
    "[controls.rpm]\nunit = \"rpm\"\nlow = 50\nhigh = 300\n"
    "[training]\ntable = \"runs.csv\"\n[outputs.torque]\nunit = \"mN m\"\n"
    "[[observe]]\nname = \"bench\"\nfile = \"bench.csv\"\n"
    "[[calibrate]]\nname = \"powder\"\nobserve = [\"bench\"]\nfree = [\"friction\", \"cohesion\"]\n";

const char* const runs =
    "friction,cohesion,rpm,torque,torque_se\n"
    "0.45,5,175,8.809887,0.08836273\n"
    "0.45,5,175,8.862245,0.08836273\n"
    "0.45,5,175,8.957568,0.08836273\n"
    "0.1,5,175,5.896749,0.05838566\n"
    "0.1875,5,175,6.583534,0.06548888\n"
    "0.275,5,175,7.24565,0.07285887\n"
    "0.3625,5,175,7.949573,0.08048629\n"
    "0.45,5,175,8.870325,0.08836273\n"
    "0.5375,5,175,9.627027,0.09648056\n"
    "0.625,5,175,10.48037,0.1048328\n"
    "0.7125,5,175,11.32808,0.113413\n"
    "0.8,5,175,12.1651,0.1222154\n"
    "0.45,0,175,6.991995,0.06984125\n"
    "0.45,1.25,175,7.4911,0.07447162\n"
    "0.45,2.5,175,8.055227,0.07910199\n"
    "0.45,3.75,175,8.418995,0.08373236\n"
    "0.45,5,175,8.801824,0.08836273\n"
    "0.45,6.25,175,9.316444,0.09299311\n"
    "0.45,7.5,175,9.754225,0.09762348\n"
    "0.45,8.75,175,10.33524,0.1022538\n"
    "0.45,10,175,10.49754,0.1068842\n"
    "0.45,5,50,12.05575,0.1202993\n"
    "0.45,5,81.25,10.40761,0.1040587\n"
    "0.45,5,112.5,9.539585,0.09621575\n"
    "0.45,5,143.75,9.005101,0.09151929\n"
    "0.45,5,175,8.669497,0.08836273\n"
    "0.45,5,206.25,8.691043,0.08608144\n"
    "0.45,5,237.5,8.452296,0.08434817\n"
    "0.45,5,268.75,8.31983,0.08298222\n"
    "0.45,5,300,8.230981,0.08187523\n";

const char* const bench =
    "rpm,torque,torque_se\n"
    "60,6.11832,0.125\n"
    "120,6.06841,0.12\n"
    "180,5.98221,0.119\n"
    "240,6.05168,0.118\n"
    "300,5.73598,0.117\n";

}  // namespace

TEST_CASE("a misfit under a surrogate in doubt asks for runs before the bench is looked at", "[uq]") {
  const TemporaryFolder folder;
  folder.write("runs.csv", runs);
  folder.write("bench.csv", bench);
  const data::StudyFile file = data::StudyFile::open(folder.write("study.toml", study_text));
  const data::Study study = data::read_study(file);
  file.finish();
  const data::RunTable table = data::read_table(study.training.table, study).table;
  const uq::CalibrationReport report = uq::calibrate_all(study, table, {.error_scan = {}, .quadrature = false}).report;
  REQUIRE(report.surrogates.at(0).verdict == uq::SurrogateWord::caution);
  const uq::CaseReport& powder = report.cases.at(0);
  REQUIRE_FALSE(powder.fits);
  CHECK_THAT(powder.remedy, Catch::StartsWith("First make the surrogate sure.") &&
                                Catch::Contains("move all inputs at once") && Catch::Contains("Then: Check"));
  CHECK_THAT(powder.consequence, Catch::StartsWith("The surrogate of torque is in doubt, too"));
}
