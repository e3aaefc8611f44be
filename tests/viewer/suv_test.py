# SPDX-License-Identifier: Apache-2.0
"""PET in Bq/ml becomes SUV in kontur open: against pydicom and the formula; where it cannot be told, one sentence says why."""
import pathlib
import shutil
import subprocess
import sys
from datetime import datetime

import pydicom
import pytest
from support import Page, running

SUPPORT = pathlib.Path(__file__).parents[1] / "support"
WEIGHT_KG, DOSE_BQ, HALF_LIFE_S = 81.5, 3.7e8, 6586.2


def write_pet(made, folder, **changes):
    """The slices as a PET image; a change that is None takes an element away. Those of the tracer begin with `tracer_`."""
    folder.mkdir()
    for number, file in enumerate(sorted(made.iterdir())):
        d = pydicom.dcmread(file)
        d.Modality, d.Units, d.DecayCorrection, d.CorrectedImage = "PT", "BQML", "START", ["DECY", "ATTN", "SCAT"]
        d.PatientWeight = WEIGHT_KG
        d.SeriesDate = d.AcquisitionDate = "20240301"
        d.SeriesTime = "003000.5"
        d.AcquisitionTime = f"00{30 + number:02}01"
        d.RescaleSlope = 3.25
        tracer = pydicom.Dataset()
        tracer.RadionuclideTotalDose, tracer.RadionuclideHalfLife = DOSE_BQ, HALF_LIFE_S
        tracer.RadiopharmaceuticalStartTime = "233000"
        for name, value in changes.items():
            item = tracer if name.startswith("tracer_") else d
            setattr(item, name.removeprefix("tracer_"), value)
            if value is None:
                delattr(item, name.removeprefix("tracer_"))
        d.RadiopharmaceuticalInformationSequence = [tracer]
        d.save_as(folder / file.name, write_like_original=False)
    return folder


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made")
    subprocess.run([sys.executable, SUPPORT / "make_dicom_series.py", "axial", folder / "axial"], check=True)
    return folder / "axial" / "dicom"


def opened(tmp_path, folder):
    with running(tmp_path, folder) as server:
        page = Page(server)
        d = pydicom.dcmread(sorted(folder.iterdir())[4])
        at = [float(v) for v in d.ImagePositionPatient]  # the first voxel of a slice
        stored = float(d.pixel_array[0, 0]) * float(d.RescaleSlope) + float(d.RescaleIntercept)
        return page.session["image"], page.do("value", at=at)["values"][0], stored


CASES = {
    "the night before": ({}, "2024-02-29 23:30:00"),
    "with its date": ({"tracer_RadiopharmaceuticalStartDateTime": "20240229224512.250000"}, "2024-02-29 22:45:12.250"),
    "days before": ({"tracer_RadiopharmaceuticalStartDateTime": "20240226003000", "tracer_RadionuclideHalfLife": 282600.0}, "2024-02-26 00:30:00"),
}


@pytest.mark.parametrize("changes, given", CASES.values(), ids=CASES)
def test_values_are_those_of_the_formula(tmp_path, made, changes, given):
    image, value, stored = opened(tmp_path, write_pet(made, tmp_path / "pet", **changes))
    waited = (datetime.fromisoformat("2024-03-01 00:30:00.500") - datetime.fromisoformat(given)).total_seconds()
    left_bq = DOSE_BQ * 2 ** (-waited / changes.get("tracer_RadionuclideHalfLife", HALF_LIFE_S))
    assert value == pytest.approx(stored * WEIGHT_KG * 1000 / left_bq, rel=1e-5)
    assert image["unit"] == "SUV (g/ml)"
    (note,) = image["notes"]
    assert note.startswith("Values are SUV by body weight: 1 g/ml is ") and "81.5 kg and 370 MBq given" in note


def test_values_that_were_corrected_to_the_injection_are_of_the_whole_dose(tmp_path, made):
    folder = write_pet(made, tmp_path / "pet", DecayCorrection="ADMIN", SeriesTime=None, tracer_RadionuclideHalfLife=None)
    image, value, stored = opened(tmp_path, folder)
    assert value == pytest.approx(stored * WEIGHT_KG * 1000 / DOSE_BQ, rel=1e-5)
    assert image["unit"] == "SUV (g/ml)"


REFUSALS = {
    "PatientWeight (0010,1030) is missing": {"PatientWeight": None},
    "PatientWeight (0010,1030) is 0; more than 0 is needed": {"PatientWeight": 0},
    "RadionuclideTotalDose (0018,1074) is missing": {"tracer_RadionuclideTotalDose": None},
    "RadionuclideTotalDose (0018,1074) is 370 Bq; from 1e5 to 1e11 is plausible": {"tracer_RadionuclideTotalDose": 370},
    "RadionuclideHalfLife (0018,1075) is missing": {"tracer_RadionuclideHalfLife": None},
    "RadiopharmaceuticalStartTime (0018,1072) is missing": {"tracer_RadiopharmaceuticalStartTime": None},
    "RadiopharmaceuticalStartDateTime (0018,1078) is missing": {"tracer_RadionuclideHalfLife": 282600.0},
    "SeriesTime (0008,0031) is missing": {"SeriesTime": None},
    "DecayCorrection (0054,1102) is \"NONE\"; START or ADMIN is needed": {"DecayCorrection": "NONE"},
    "CorrectedImage (0028,0051) is \"DECY\\SCAT\", without ATTN": {"CorrectedImage": ["DECY", "SCAT"]},
    "the series' time is after the acquisition's, so that it does not say when the scan began": {"SeriesTime": "113000"},
    "the tracer, whose half-life is 109.8 min, was given 30 min after the scan began": {"tracer_RadiopharmaceuticalStartDateTime": "20240301010000.5"},
    "the tracer, whose half-life is 109.8 min, was given 1440 min before the scan began": {"tracer_RadiopharmaceuticalStartDateTime": "20240229003000.5"},
}


@pytest.mark.parametrize("sentence, changes", REFUSALS.items())
def test_what_is_missing_is_named_and_values_stay(tmp_path, made, sentence, changes):
    image, value, stored = opened(tmp_path, write_pet(made, tmp_path / "pet", **changes))
    assert image["notes"] == [f"Values stay in Bq/ml, since SUV cannot be told: {sentence}."]
    assert image["unit"] == "Bq/ml" and value == pytest.approx(stored, rel=1e-6)


def test_a_project_knows_its_image_again(tmp_path, made):
    folder = write_pet(made, tmp_path / "pet")
    project = tmp_path / "work.kontur"
    for _ in range(2):
        with running(tmp_path, folder, "--project", project) as server:
            assert Page(server).session["image"]["unit"] == "SUV (g/ml)"
    shutil.rmtree(folder)
    write_pet(made, folder, PatientWeight=None)
    with running(tmp_path, folder, "--project", project) as server:
        assert Page(server).session["image"]["unit"] == "Bq/ml", "the same voxels, without a weight"
