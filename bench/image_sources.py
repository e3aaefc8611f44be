# SPDX-License-Identifier: Apache-2.0
"""Structures with their images, for images.py: of the scans that bench/organ_sources.py lists, and of patients apart from them.

Every structure belongs to an object; images and structures of one object stay together in one set. Objects of the scans are, sorted
by name, `report` and `tune` in turns. Structures of FRESH are `fresh`: nothing was ever chosen on their patients, but for
sarcomas 031 and 037, of which three drawings showed what to mend (docs/decisions/0008-image-error.md).

FRESH is a folder of public data:
- sarcoma/STS_NNN/{CT,MR_T1,PET}_{image,mask}.nii.gz: ibsi_validation/nifti of github.com/theibsi/data_sets (CC BY 3.0), hand-drawn;
- ventricles/: what ventricles.py makes of the Sunnybrook cases in github.com/kwu93/image-segmentation (CC0), hand-drawn;
- mr_abdomen/example_{mr_sm,seg_mr}.nii.gz, aorta/{ct_cropped,aorta,vertebrae_T12}.nii.gz: tests/reference_files of
  github.com/wasserth/TotalSegmentator (Apache-2.0), a model's labels.

NEW is another such folder, of patients that are in no other set; nothing was chosen on them either:
- sarcoma/: the patients of the same repository that are left, in CT, MR or PET in turns;
- pyradiomics/{brain2,breast1}_{image,label}.nrrd: data of github.com/AIM-Harvard/pyradiomics (BSD-3);
- cord/t1w{,_seg-manual}.nii.gz: t1 of github.com/spinalcordtoolbox/sct_testing_data (MIT), hand-drawn;
- chest/{ct_cropped,heart,pulmonary_artery}.nii.gz: tests/reference_files/pulmonary_report/models of
  github.com/wasserth/TotalSegmentator, a model's labels.
"""
ABDOMEN = "01_ct_abdomen_totalseg_3mm/"
BRAIN = "06_mr_brain_MRIcrop/"
CINE = "10_cine_mr_SC-HF-I-1/"
# Every label of at least 300 voxels; vertebrae are whole in the map of their own.
ABDOMEN_LABELS = [1, 2, 3, 4, 5, 6, 7, 11, 14, 18, 19, 20, 52, 63, 64, 79, 86, 87, 88, 89, 117]
PHANTOM = (("liver", "3"), ("kidney", "1.5"), ("metastasis", "1"), ("vertebra", "1.5"))

# Every third patient that is not among the scans, CT, MR and PET in turns, as far as the repository has the image.
FRESH_SARCOMAS = ("001", "004", "007", "010", "013", "016", "019", "022", "025", "028", "031", "034", "037", "041", "043", "046", "049")
FRESH_WITHOUT_CT = ("007", "013", "016", "037", "046", "049")
MODALITIES = ("CT", "MR_T1", "PET")
# Without an image in every modality that the turn asks for, which is then the next one's.
NEW_SARCOMAS = {
    "CT": ("003", "014", "018", "023", "032", "036", "042", "047", "051"),
    "MR_T1": ("005", "011", "015", "024", "027", "029", "033", "038", "044", "048"),
    "PET": ("006", "009", "012", "017", "020", "021", "026", "030", "035", "039", "045", "050"),
}
# Patient, phase of the end of diastole, of systole.
FRESH_VENTRICLES = (("SC-HF-I-2", 19, 6), ("SC-HF-I-4", 19, 6), ("SC-HF-I-5", 19, 6), ("SC-HF-I-6", 18, 8))
FRESH_MR_LABELS = (1, 2, 3, 4, 5, 6, 7, 13, 14, 15, 19, 20, 21, 23, 24, 25, 46, 47)


def scans():
    """{structure: words for kontur_images}, files relative to the scans."""
    found = {f"abdomen_{label:03d}": (ABDOMEN + "example_ct_sm.nii.gz", ABDOMEN + "example_seg.nii.gz", str(label))
             for label in ABDOMEN_LABELS}
    found |= {f"vertebra_{label:03d}": (ABDOMEN + "example_ct.nii.gz", ABDOMEN + "vertebrae_on_example_ct.nii.gz", str(label))
              for label in range(26, 33)}
    found |= {f"brain_{label:03d}": (BRAIN + "MRIcrop-orig.nii.gz", BRAIN + "MRIcrop-seg.nii.gz", str(label))
              for label in range(1, 9)}
    for number, patient in ("03", "002"), ("04", "040"), ("05", "008"):
        for modality in "CT", "MR_T1":
            folder = f"{number}_sarcoma_STS_{patient}/{modality}/"
            found[f"sarcoma{patient}/{modality}"] = (folder + "image", folder + f"{modality}_mask.nii.gz", "")
    found["tumour"] = ("07_mr_brain_tumour_brain1/brain1_image.nrrd", "07_mr_brain_tumour_brain1/brain1_label.nrrd", "")
    found["cord"] = ("13_mr_spinal_cord_t2/t2.nii.gz", "13_mr_spinal_cord_t2/t2_seg-manual.nii.gz", "")
    for wall in "endo", "epi":
        found[f"ventricle_{wall}"] = (CINE + "cine4d_crop.nii.gz", CINE + f"mask_ED_{wall}.nii.gz", "", "19")
    found |= {f"phantom_{organ}": ("phantom", organ, spacing) for organ, spacing in PHANTOM}
    return dict(sorted(found.items()))


def fresh():
    """The same, files relative to FRESH."""
    found = {}
    for number, patient in enumerate(FRESH_SARCOMAS):
        modality = MODALITIES[number % 3]
        if modality == "CT" and patient in FRESH_WITHOUT_CT:
            modality = "MR_T1"
        folder = f"sarcoma/STS_{patient}/{modality}_"
        found[f"fresh_sarcoma{patient}/{modality}"] = (folder + "image.nii.gz", folder + "mask.nii.gz", "")
    for patient, diastole, systole in FRESH_VENTRICLES:
        for phase, wall in ((diastole, "endo"), (diastole, "epi"), (systole, "endo")):
            name = f"ventricles/{patient}_{phase:02d}_"
            found[f"fresh_{patient}/{phase:02d}_{wall}"] = (name + "image.nii.gz", name + f"{wall}.nii.gz", "")
    found |= {f"fresh_mr_{label:03d}": ("mr_abdomen/example_mr_sm.nii.gz", "mr_abdomen/example_seg_mr.nii.gz", str(label))
              for label in FRESH_MR_LABELS}
    for organ in "aorta", "vertebrae_T12":
        found[f"fresh_{organ}"] = ("aorta/ct_cropped.nii.gz", f"aorta/{organ}.nii.gz", "")
    return dict(sorted(found.items()))


def new():
    """The same, files relative to NEW."""
    found = {f"new_sarcoma{patient}/{modality}": (f"sarcoma/STS_{patient}/{modality}_image.nii.gz",
                                                  f"sarcoma/STS_{patient}/{modality}_mask.nii.gz", "")
             for modality, patients in NEW_SARCOMAS.items() for patient in patients}
    for name in "brain2", "breast1":
        found[f"new_{name}"] = (f"pyradiomics/{name}_image.nrrd", f"pyradiomics/{name}_label.nrrd", "")
    found["new_cord"] = ("cord/t1w.nii.gz", "cord/t1w_seg-manual.nii.gz", "")
    for organ in "heart", "pulmonary_artery":
        found[f"new_{organ}"] = ("chest/ct_cropped.nii.gz", f"chest/{organ}.nii.gz", "")
    return dict(sorted(found.items()))


def sets():
    """{structure: "report", "tune", "fresh" or "new"}."""
    objects = sorted({name.split("/")[0] for name in scans()})
    found = {name: ("tune" if objects.index(name.split("/")[0]) % 2 else "report") for name in scans()}
    return found | {name: "fresh" for name in fresh()} | {name: "new" for name in new()}
