#!/usr/bin/env python3
"""Renames identifiers and rewrites messages, help texts and comments to the field's words.

    field_words.py FOLDER [--dry-run] [--report]

Works on the git-tracked files of FOLDER; can be rerun (a second run changes nothing). Afterwards: clang-format -i on the
changed files (done here if clang-format is found), node scripts/draw_modules.mjs, build, test. Prints collisions and test literals that still
have a word that was replaced elsewhere; stops before writing if a new identifier exists already.
"""
import re, subprocess, sys, shutil, os

root = sys.argv[1]
dry = '--dry-run' in sys.argv

# 1. Identifiers that are distinctive: whole word, in code, comments and documents.
EVERYWHERE = {
    # where the handle is in the hand
    'Lay': 'HandlePose', 'usual_lay': 'usual_pose', 'lay_turn': 'turn_in_pose', 'lay_beside': 'place_beside',
    'ThumbWay': 'ThumbPose', 'find_way': 'find_pose', 'kBettered': 'kImproved', 'kNearSlant': 'kNearTilt',
    # placed, not laid
    'LaidSkeleton': 'PlacedSkeleton', 'lay_skeleton': 'place_skeleton', 'LaidModel': 'PlacedModel',
    'lay_model': 'place_model', 'LaidHand': 'PlacedHand', 'laid_hand': 'placed_hand',
    'laid_on_table': 'posture_on_table', 'LaidOnTable': 'PostureOnTable', 'laid_in_palm': 'placed_in_palm',
    'lay_back': 'project_back', 'lay_bands': 'place_bands', 'lay_links': 'place_links', 'lay_finger': 'section_finger',
    'lay_heads': 'section_heads', 'lay_wrist': 'section_wrist', 'lay_frame': 'place_frame', 'lay_plane': 'fit_crease_plane',
    'lay_finger_creases': 'place_finger_creases', 'lay_palm_creases': 'place_palm_creases', 'lay_web': 'place_web',
    # separated, not parted
    'part_touching_sheets': 'separate_touching_sheets', 'PartSheetsResult': 'SeparatedSheets',
    'PartSheets': 'SeparateTouchingSheets', 'parted_edges': 'separated_edges', 'may_be_parted_': 'may_be_split_',
    'otsu_parting': 'otsu_threshold', 'OtsuParting': 'OtsuThreshold',
    # repaired, not mended
    'mend_low_triangles': 'repair_low_triangles', 'mend_low': 'repair_low', 'mend_round': 'repair_round',
    'mended_patches': 'repaired_patches',
    # noise, rectified sheets, oblique things
    'kWaves': 'kRipples', 'DrawnSheet': 'RectifiedSheet', 'skin_drawn_in': 'shrunk_skin',
    'kAskew': 'kOblique', 'kAslant': 'kOblique', 'seen_aslant': 'seen_obliquely', 'goes_first': 'comes_first',
    'goes_round': 'surrounds', 'stands_lower': 'is_lower', 'stands_off': 'height_above',
    # reported, not told
    'rethrow_told_error': 'rethrow_reported_error', 'told_unit': 'stated_unit', 'kMostTold': 'kMostListed',
    'kTold': 'kNamed', 'tell_pairs': 'describe_pairs', 'tell_unbalanced': 'describe_unbalanced',
    'tell_what_is_left': 'report_what_is_left', 'tell_what_is_left_out': 'report_what_is_left_out',
    'told_by_': 'found_by_', 'is_told_': 'is_found_by_dots_', 'drop_what_cannot_be_told': 'drop_undetermined',
    'kTellsLittle': 'kShowsLittle',
}

# 2. Words that are common: whole word, code only, in files whose name begins so (however they move).
LOCAL = [
    ('placement', {'lay': 'pose', 'bettered': 'improved_holds'}),
    ('power_place', {'lay': 'pose', 'bettered': 'improved', 'way': 'thumb_pose'}),
    ('thumb_closing', {'ways': 'goals', 'way': 'goal', 'bettered': 'improved'}),
    ('separate_sheets', {'parted': 'separated'}),
    ('repair', {'parted': 'separated', 'mended': 'repaired'}),
    ('bone_regions', {'parted': 'regions_at'}),
    ('phantom_sheet', {'laid': 'placed'}),
    ('hand_from_scan', {'laid': 'placed_model', 'lacking': 'missing_note'}),
    ('placed_skeleton', {'laid': 'placed'}),
    ('outline_model', {'laid': 'placed'}),
    ('outline_person', {'laid': 'placed', 'is_told': 'is_known'}),
    ('found_creases', {'laid': 'placed'}),
    ('bound_dots', {'laid': 'placed'}),
    ('skin_mask', {'parting': 'threshold'}),
    ('otsu', {'parting': 'threshold'}),
    ('card_view', {'askew': 'skew'}),
    ('reach', {'askew': 'oblique'}),
    ('low_triangles', {'mended': 'repaired'}),
    ('mesh_distance_test', {'mended': 'repaired_mesh'}),
    ('grasp_commands', {'told': 'words'}),
    ('scan_hand', {'told': 'stated'}),
    ('quick_command_test', {'told': 'reported'}),
    ('population_table_commands', {'tell': 'report_notes'}),
    ('text', {'is_told': 'is_listed'}),
    ('lens_calibration_test', {'told': 'with_stated'}),
    ('core_test', {'told': 'reported'}),
    ('effort_test', {'is_told': 'is_reported'}),
    ('csv_reader', {'told': 'stated'}),
    ('worker', {'told': 'reported'}),
    ('hand_instance', {'told': 'summary'}),
    ('instance_problem', {'told': 'summary'}),
    ('hand_from_scan_json', {'told': 'by_dots'}),
    ('sheet_view', {'told': 'proportion_misfit', 'kTells': 'kClear', 'is_parted': 'is_cut'}),
    ('study_verdict', {'is_told': 'is_stated', 'told': 'listed'}),
    ('study_analysis', {'is_told': 'is_stated'}),
    ('imprint_test', {'told': 'wall_gauge'}),
    ('study_store_test', {'told': 'number_kept'}),
    ('product_faces_test', {'told': 'listed'}),
    ('hand_scale_command_test', {'told': 'reported'}),
    ('outline_person_test', {'told': 'stated'}),
    ('posture_fit', {'anew': 'again'}),
    ('gloved_test', {'anew': 'again'}),
    ('precision_search', {'laid': 'placed_opening'}), ('table_posture_test', {'laid': 'placed'}), ('hand_from_photos', {'told': 'reported'}),
    ('separate_sheets_test', {'mended': 'repaired'}), ('study_run_commands', {'tell': 'print_outcome'}), ('study_analysis', {'tell': 'add_note'}),
    ('hand_from_scan', {'kTells': 'kDetermines'}),
]

# 2b. Common words in all code (after 2), not in comments or strings.
CODE_ONLY = {'Waves': 'SmoothNoise', 'tell': 'on_note', 'Tell': 'OnNote', 'tell_of_photograph': 'note_photograph'}

# 3. Names of tests: parts of the PascalCase name, in order.
TESTS = [
    ('IsToldWithItsValue', 'IsReportedWithItsValue'), ('AreToldApart', 'AreDistinguished'), ('IsToldFrom', 'IsDistinguishedFrom'),
    ('AreToldByTheirOrder', 'AreRecognisedByTheirOrder'), ('AreHeldAndTold', 'AreClampedAndReported'),
    ('HeededAndTold', 'RespectedAndReported'), ('IsDroppedAndTold', 'IsDroppedAndReported'), ('AndIsTold', 'AndIsReported'),
    ('UnlessToldOtherwise', 'UnlessStatedOtherwise'), ('IsToldAsOne', 'IsReportedAsOne'), ('WhatIsToldCounts', 'WhatIsStatedCounts'),
    ('CannotBeTold', 'CannotBeDistinguished'), ('AtTheTold', 'AtTheRequested'), ('IsTold', 'IsReported'), ('AreTold', 'AreReported'),
    ('AndTold', 'AndReported'), ('TellsA4FromLetter', 'DistinguishesA4FromLetter'),
    ('TellsABackgroundFromAFullBox', 'DistinguishesABackgroundFromAFullBox'),
    ('TellsAHandBesideACard', 'ReportsAHandBesideACard'), ('TellsAHoleFromARod', 'DistinguishesAHoleFromARod'),
    ('TellsOuterAndInnerEdgesOfAStep', 'DistinguishesOuterAndInnerEdgesOfAStep'),
    ('TellsProductsOfOneNameApartBySource', 'DistinguishesProductsOfOneNameBySource'),
    ('TellsThe', 'ReportsThe'), ('TellsAn', 'ReportsAn'), ('TellsA', 'ReportsA'), ('TellNothing', 'DetermineNothing'),
    ('TellsNothing', 'DeterminesNothing'), ('TellTheHinge', 'DetermineTheHinge'), ('PhotographsCantTell', 'PhotographsDoNotDetermine'),
    ('CannotTell', 'CannotDetermine'), ('Tells', 'Reports'), ('Tell', 'Report'),
    ('RolledAnew', 'RolledAgain'), ('BoxLiesAskew', 'BoxIsOblique'), ('LaysPointsOnto', 'ProjectsPointsOnto'),
    ('MendTheThumbBall', 'CorrectTheThumbBall'), ('NamesWhatLacks', 'NamesWhatIsMissing'),
]

# 4. Messages, help texts, report: in string literals (adjacent ones joined) and in documents.
PHRASES = [
    ("tells how a handheld product will feel", "shows how a handheld product will feel"),
    ('"not told"', '"not stated"'),
    (": tells whether the hand holds the load; default", ": shows whether the hand holds the load; default"),
    ("Intensity that parts skin from air", "Intensity that separates skin from air"),
    ("Intensity that parts cortical bone", "Intensity that separates cortical bone"),
    ("found likewise", "found in the same way"),
    ("Point of the product that lies in mid-palm", "Point of the product that is in the middle of the palm"),
    ("(or the name of its folder) tells the posture", "(or the name of its folder) gives the posture"),
    ("which another run takes up; default", "which another run reuses; default"),
    ("The name tells the posture", "The name gives the posture"),
    ("The file's name tells it:", "The file's name gives it:"),
    ("is left out: it lies {:.1f} mm from its place", "is left out: it is {:.1f} mm from its place"),
    ("look swapped: each lies where the other belongs", "look swapped: each is where the other belongs"),
    ("the markers don't tell ", "the markers don't determine "),
    ("the mesh doesn't tell ", "the mesh doesn't determine "),
    ("of 100 such hands lie within", "of 100 such hands are within"),
    ("the thumb lies in the way of the breadth over the knuckles; it follows from the rest",
     "the thumb covers the breadth over the knuckles, which follows from the rest"),
    ("A hand from a few measures,", "A hand from a few measurements,"),
    ("tells how well each dimension is known", "says how well each dimension is known"),
    ("default: a sheet, told by its shape", "default: a sheet, recognised by its shape"),
    ("the crease of the wrist lies, or beyond", "the crease of the wrist is, or beyond"),
    ("every dimension in the row's columns is asked for", "every dimension in the row's columns is requested"),
    ("default: only tell what is met", "default: only print what is met"),
    ("segments, regions and joints are laid over the surface", "segments, regions and joints are fitted to the surface"),
    ("its name doesn't tell the posture", "its name doesn't give the posture"),
    ("names no posture and is passed over", "names no posture and is ignored"),
    ("its colours stand {:.1f} mm apart", "its colours are {:.1f} mm apart"),
    ("lies {:.1f} mm off the scan", "is {:.1f} mm off the scan"), ("or go on with setting", "or continue with setting"),
    ("Hand that tells what bones there are", "Hand that names the bones"),
    ("bones are laid on their intensities, which is more accurate than on their surfaces",
     "bones are aligned by their intensities, which is more accurate than by their surfaces"),
    ("of the skin lie outside of the image", "of the skin are outside the image"),
    ("The other hand lies beside it", "The other hand is beside it"),
    ("instead of a person of its own", "instead of a synthetic person"),
    ("inside the sheet's edge the wrist crease lies", "inside the sheet's edge the wrist crease is"),
    ("whether the hand moved can't be told", "whether the hand moved can't be determined"),
    ("tilted every way tell them better", "tilted every way give better ones"),
    ("tell cameras apart", "distinguish the cameras"),
    ("which tell less", "which is less accurate"),
    ("The board that the hand stands on, to be printed", "The board under the hand, to be printed"),
    ("of a hand that stands on the middle of the board", "of a hand on the middle of the board"),
    ("{} as told (file: {})", "{} as given (file: {})"),
    (" as told (file: ", " as given (file: "),
    ("a folder stands alone; --format step,stl tells which files it gets",
     "a folder can't be combined with other outputs; --format step,stl says which files it gets"),
    ('"as told"', '"as given"'),
    ("every hand along the handle until its imprint lies best on those of all",
     "every hand along the handle until its imprint fits those of all best"),
    ("in 30 hands; go on with", "in 30 hands; continue with"),
    ("; delete it and run the study anew", "; delete it and run the study again"),
    ("` goes on", "` continues"),
    ("delete the file to begin anew", "delete the file to start again"),
    (": goes on after {} grasps", ": continues after {} grasps"),
    ("Say what would run", "Print what would run"),
    ("Run a study, or go on with it where its store is there", "Run a study, or continue it if its store exists"),
    ("tells how far they are", "shows how far they are"),
    ("Hold the simulator against closed forms and measurements", "Compare the simulator with closed forms and measurements"),
    ("Say what the cases are, run nothing", "List the cases, run nothing"),
    ("Say what Palmar needs on this machine", "Show what Palmar needs on this machine"),
    ("fillets hang together with what was changed and were rolled anew by their radii",
     "fillets are connected with what was changed and were rolled again with their radii"),
    ("inside and outside can't be told", "inside and outside can't be determined"),
    ("an edge lies off the surface", "an edge is off the surface"),
    ("a corner lies off its edge", "a corner is off its edge"),
    ("the finest that is chosen without being told", "the finest that is chosen automatically"),
    ("the coarsest that is chosen without being told", "the coarsest that is chosen automatically"),
    ("assemblies stand within assemblies more than", "assemblies are nested more than"),
    ("body was faulty and was mended", "body was faulty and was repaired"),
    ("bodies were faulty and were mended", "bodies were faulty and were repaired"),
    ("the thumb's metacarpal stands {:.0f} degrees from", "the thumb's metacarpal is {:.0f} degrees from"),
    (" stands twice, first in ", " appears twice, first in "),
    ("{} and {} lie {:.0f} mm apart", "{} and {} are {:.0f} mm apart"),
    ("{} voxels lie in it; {} or more", "{} voxels are in it; {} or more"),
    ("shows too few bones of the palm to lay the hand on it", "shows too few bones of the palm to align the hand with it"),
    ("{}: lies {}{:.1f} mm from the skin in the scan of the grasp; it must stand where it was",
     "{}: is {}{:.1f} mm from the skin in the scan of the grasp; it must be where it was"),
    ("with x and y negated it lies in the hand", "with x and y negated it is in the hand"),
    ("as it stands in that bone's joint", "as it is in that bone's joint"),
    ("without a surface of its own, found by the image alone", "without a surface, found by the image alone"),
    ("laid on its surface instead, which is less accurate", "aligned by its surface instead, which is less accurate"),
    ("The posture tells nothing of their joints", "The posture says nothing about their joints"),
    ("are needed to tell where the hand is", "are needed to find where the hand is"),
    ("are needed to tell how the hand moved", "are needed to find how the hand moved"),
    ("it was parted there", "it was separated there"),
    ("corners of the board lie {:.1f} pixels from", "corners of the board are {:.1f} pixels from"),
    ("the hand's colour doesn't tell it from what is behind it", "the hand's colour doesn't distinguish it from what is behind it"),
    ("which takes longer and is less sure", "which takes longer and is less certain"),
    ("the hand can't be told from what is behind it, stands outside of the box",
     "the hand can't be distinguished from what is behind it, is outside the box"),
    ("the hand can't be told from what is behind it", "the hand can't be distinguished from what is behind it"),
    ("creases' colour lies on no crease", "creases' colour is on no crease"),
    ("which tells where fingers bend to 2 to 4 mm", "which shows where fingers bend to 2 to 4 mm"),
    ("the nearest lies {:.1f} mm away", "the nearest is {:.1f} mm away"),
    ("shows too few bones of the palm to tell where the hand is", "shows too few bones of the palm to find where the hand is"),
    ("% of the scanned skin lies more than 2 mm", "% of the scanned skin is more than 2 mm"),
    ("triangles laid over the skin by registration of", "triangles fitted to the skin by registration of"),
    ("lay the hand on a plain table", "place the hand on a plain table"),
    ("only one may lie there", "only one may be there"),
    ("the card lies askew to the forearm, by {:.0f} degrees; lay one of its edges level with the crease of the wrist, square to the forearm",
     "the card isn't parallel to the forearm, by {:.0f} degrees; place one of its edges level with the crease of the wrist, perpendicular to the forearm"),
    ("the wrist crease lies {} mm inside the edge", "the wrist crease is {} mm inside the edge"),
    ("telling the hand from what is behind it", "separating the hand from what is behind it"),
    ("mm, is to lie there", "mm, must be there"),
    ("all but the wrist must lie on it", "all but the wrist must be on it"),
    ("no model of a hand could be laid as this one lies", "no model of a hand could be placed like this one"),
    ("lay the hand on a white sheet", "place the hand on a white sheet"),
    ("something white lies beside it", "something white is beside it"),
    ("the hand or something else lies over it", "the hand or something else covers it"),
    ("all but the wrist must lie within the sheet", "all but the wrist must be within the sheet"),
    ("; lay hand and card on something", "; place hand and card on something"),
    ("what friction can hold is only known to lie between", "what friction can hold is only known to be between"),
    ("no skin in contact lies on a coated part", "no skin in contact is on a coated part"),
    (" skin vertices lie deeper than ", " skin vertices are deeper than "),
    ("equal to G0: one modulus was asked for", "equal to G0: one modulus was requested"),
    ("it stands at the end of what is tried", "it is at the end of the range that is tried"),
    ("so that the force at its tip can't be told", "so that the force at its tip can't be determined"),
    ("element {} stands where an item belongs", "element {} is where an item belongs"),
    ("slices lie in {} directions", "slices are in {} directions"),
    ("all slices lie at one position", "all slices are at one position"),
    ("slices {:g} mm thick lie {:g} mm apart", "slices {:g} mm thick are {:g} mm apart"),
    ("its first voxel lies {:g} mm away from the origin", "its first voxel is {:g} mm away from the origin"),
    ("the file doesn't say how the image lies in the patient", "the file doesn't say how the image is oriented in the patient"),
    ("(values in a file of their own aren't read)", "(values in a separate file aren't read)"),
    ("its values lie in a file of their own", "its values are in a separate file"),
    (", which lies outside its folder", ", which is outside its folder"),
    (" lies outside its buffer", " is outside its buffer"),
    (" lies outside the file's own folder", " is outside the file's own folder"),
    (" is reached twice or lies deeper than 200 levels", " is reached twice or is deeper than 200 levels"),
    (" vertices stand above it", " vertices come before it"),
    (" stand above it", " come before it"),
    ("a property stands before the first element", "a property comes before the first element"),
    (" values can't stand in this file", " values can't be in this file"),
    (": components lie deeper than 32 levels", ": components are deeper than 32 levels"),
    (" stands twice; the first point has it", " appears twice; the first point has it"),
    (" edges lie on ", " edges are on "),
    ("not where the reference hand holds it: a place of its own", "not where the reference hand holds it: at its own place"),
    ("half of such postures lie within ", "half of such postures are within "),
    ("else 0: 0 lies strictly inside", "else 0: 0 is strictly inside"),
    ("the given point lies %.0f mm off the product", "the given point is %.0f mm off the product"),
    (" lies on the side of its ", " is on the side of its "),
    ("%.0f N were asked for, which the hand doesn't reach", "%.0f N were requested, which the hand doesn't reach"),
    ("wrist crease: its middle lies outside of the skin", "wrist crease: its middle is outside the skin"),
    (" is asked for; the hand has 0 to ", " is requested; the hand has 0 to "),
    ("the points lie {:.3g} mm from their middle", "the points are {:.3g} mm from their middle"),
    ("{} points don't tell how the palm is turned", "{} points don't show how the palm is turned"),
    ("trying ways in which the hand may lie", "trying placements of the hand"),
    ("markers coincide or lie too close for beta", "markers coincide or are too close for beta"),
    ("not described well enough to press it anew", "not described well enough to repeat it"),
    ("one normal distribution stands for two", "one normal distribution represents two"),
    ("the sexes aren't told apart", "the sexes aren't distinguished"),
    ("a person's hand can't be told from no measure; one is needed", "no measurement of the person is given; one is needed"),
    ("each may stand once", "each may appear once"),
    ("it can't be told which side is outside", "it can't be determined which side is outside"),
    ("with its cap on; drawn in at a waist", "with its cap on; narrower at a waist"),
    ("how far the waist is drawn in", "how deep the waist is"),
    ("how far the flange stands out", "how far the flange projects"),
    ("by which the foot lies behind", "by which the foot is behind"),
    ("by which the handle is drawn in around its belly", "by which the handle is narrower around its belly"),
    ("free edge lies", "free edge is"), ("free edges lie", "free edges are"),
    ("triangles that stand there twice", "duplicate triangles"),
    (" as told, though the file says ", " as given, though the file says "),
    (", doesn't tell (longest side ", ", is ambiguous (longest side "),
    ("photographs tell position and camera", "photographs give position and camera"),
    ("the names of n photographs tell position", "the names of n photographs give position"),
    ('\\" lies in an unknown segment', '\\" is in an unknown segment'),
    ("decimal commas need cells parted by semicolons", "decimal commas need cells separated by semicolons"),
    ("this label stands twice", "this label appears twice"),
    (" stands where a number is needed", " is where a number is needed"),
    (" tells no product that Palmar makes", " describes no product that Palmar makes"),
    (": a value stands there twice", ": a value appears twice"),
    ("a path with a line break can't stand in a batch script", "a path with a line break can't be in a batch script"),
    ("to go on where the store stopped", "to continue where the store stopped"),
    ("without the file resume goes on with the shape it has kept", "without the file resume continues with the shape in the store"),
    ("` goes on with it", "` continues it"),
    (": doesn't go on over the length that hands touch", ": doesn't extend over the length that hands touch"),
    ("posture and depth have ranges of their own that are not in these", "posture and depth have their own ranges, which are not in these"),
    (" stand in faces.csv", " are in faces.csv"),
    ("as deep as the bones of this hand stand under it; fat, nail and tendons are not told apart",
     "as thick as the skin over the bones of this hand; fat, nail and tendons are not distinguished"),
    ("come in families ten times apart", "come in families that differ tenfold"),
    (" stand against the peak pressure;", " are compared with the peak pressure;"),
    ("blood flow stops stand against the peak averaged", "blood flow stops is compared with the peak averaged"),
    (" N asked for", " N requested"),
    ("A limit of its own family, for sustained grips: it is lower than the film values above because it asks another question",
     "This limit belongs to another family, for sustained grips: it is lower than the film values above because it answers another question"),
    ("Each stands for itself: they are never added up", "They are never added up"),
    ("coloured by how far its skin lies from the scanned one", "coloured by the distance of its skin from the scanned one"),
    ("what the dots changed of the axis that the skin told", "what the dots changed of the axis found by the skin"),
    ("the hand's skin lies {:.2f} mm from", "the hand's skin is {:.2f} mm from"),
    ("Skin that would be inside the product is laid on its surface", "Skin that would be inside the product is moved onto its surface"),
    ("equations and tissue stand under Provenance", "equations and tissue are under Provenance"),
    ("Its figures stand beside this file", "Its figures are beside this file"),
    ("Further conditions stand below", "Further conditions are below"),
    ("not every hand comes to the force that was told", "not every hand reaches the requested force"),
    (" stands behind that of task ", " comes after that of task "),
    ("only a product grasped by itself is allowed", "only a product that is grasped itself is allowed"),
    ("tasks to run are not ascending, or one stands there twice", "tasks to run are not ascending, or one appears twice"),
    ("a share of the grip strength is asked for", "a share of the grip strength is requested"),
    # help texts
    ('Hold it by the surface inside this box', 'Hold the product by the surface inside this box'),
    ('for part of its description; again for others', 'for part of its description; may be given several times'),
    ('"Posture to leave out, for a spoilt series"', '"Posture to leave out, for example because its series is spoilt"'),
    ('What the grasp holds, where it was in the scanner', 'The object that the grasp holds, where it was in the scanner'),
    ("Go on though a slice doesn't belong between its neighbours", "Continue although a slice doesn't fit between its neighbours"),
    ('"Only the hand"', '"Write only the hand, no report"'),
    ('"Any other, NAME=MM; repeatable"', '"Any other dimension, NAME=MM; may be given several times"'),
    ('"Of what people: a name or a .toml file"', '"Population that the person belongs to: a name or a .toml file"'),
    ('"The palm looks at the camera"', '"The palm faces the camera"'),
    ('Store to write; if it is there and of this study, what is missing is run', 'Store to write; an existing store of this study is continued'),
    ('Hands to draw from each population', 'Number of hands to sample from each population'),
    ('new: grasped by themselves', 'new: each is grasped on its own'),
    ('"Of the overlap of undeformed skin and product, 0 to 1: 1 makes room for all"', '"Share of the overlap of undeformed skin and product that is removed, 0 to 1"'),
    ('"Never deeper"', '"Largest depth, mm"'),
    ('"Thickness that must remain"', '"Wall thickness that must remain, mm"'),
    ('"Over which the depth grows beside them"', '"Width over which the depth grows beside kept faces and boxes, mm"'),
    ('"Standard deviation of the smoothing"', '"Standard deviation of the smoothing, mm"'),
    ('"Round the imprint, over which the depth ends"', '"Width round the imprint over which the depth falls to 0, mm"'),
    ('"Longest edge of triangles that move"', '"Longest edge of triangles that move, mm"'),
    ('"Of fillets"', '"Smallest radius of fillets, mm"'),
    ('Most hands that may lose hold, as a share', 'Largest share of hands that may no longer hold the product, out'),
    ('"Most candidates that hands hold"', '"Largest number of candidates that are made and held"'),
    ('"Of a groove\'s section: the cutter\'s"', '"Radius of a groove\'s section, that of the cutter, mm"'),
    ('"Radius along a groove\'s rims"', '"Radius along the edges of a groove, mm"'),
    ('"Smallest cutter that can be used"', '"Smallest cutter radius that can be used, mm"'),
    ('"Sizes are rounded to this, as a machine keeps it"', '"Sizes are rounded to this step, mm"'),
    ("Only make the shape; hands don't hold it again", 'Only make the shape, without a comparison'),
    ('"Instead of the tissue\'s own G(d), kPa"', '"One shear modulus instead of the tissue\'s own G(d), kPa"'),
    ("Don't search: say which features carry the peaks, try a change of each, and rank them by what they gain", "Don't search: list the features that carry the peaks, try one change of each, and rank the changes by their gain"),
    ('Synthetic persons, whose truth is known', 'Synthetic persons with known truth'),
    ('MR images: what is in them, single steps', 'MR images: contents, single steps'),
    ('"Whose hands: built-in populations, tables of subjects"', '"Built-in populations and tables of subjects"'),
    ('"Where the markers sit:', '"Where the markers are:'),
    ('Where the markers sit: a CSV', 'Where the markers are: a CSV'),
    ('"How far a marker is expected to be off"', '"Expected error of a marker (standard deviation), mm"'),
    ('"Which frame of a file with several: its number, or all"', '"Frame of a file that has several: its number, or all"'),
    ('"Everything times one factor instead"', '"Scale everything by one factor instead"'),
    ('"Of the tissue, kPa"', '"Shear modulus of the tissue, kPa"'),
    ('"Of the tissue, below 0.5"', '"Poisson\'s ratio of the tissue, below 0.5"'),
    ('default: the middle of the phalanx before', 'default: the middle of the phalanx proximal to it'),
    ('"Tissue file over the hand\'s own"', '"Tissue file that replaces values of the hand\'s own tissue"'),
    ('Tissue file to write, *.toml: a start for one of your own', 'Tissue file to write, *.toml, to start your own from'),
    ('with drawn creases and dots if it may be', 'with creases and dots drawn on the skin if possible'),
    ('What a file shows: FILE=POSTURE; again for others', 'Posture that a file shows: FILE=POSTURE; may be given several times'),
    ('What a folder shows: FOLDER=POSTURE; again for others', 'Posture that a folder shows: FOLDER=POSTURE; may be given several times'),
    ('Of files that carry none: mm, cm, m or inch; default: what makes a hand of it', 'Unit of files that carry none: mm, cm, m or inch; default: the one with which the scan is a hand'),
    ('"The mesh ends so far above the board"', '"Height above the board at which the mesh ends, mm"'),
    ('"What a pixel covers on the hand, for stereo"', '"Size of a pixel on the hand for stereo, mm"'),
    ("The hand surely did not move: don't look for it", "The hand certainly didn't move: don't correct its motion"),
    ('"Like info; exit code 5 if something is wrong"', '"Check a product like info, with exit code 5 if something is wrong"'),
    ('Repair what is safe, say what was done and what is left', 'Repair what is safe, and report what was done and what is left'),
    ('"Another format, in mm, welded and oriented"', '"Convert to another format, in mm, welded and oriented"'),
    ('Vertices this near become one; without it', 'Vertices nearer than this become one; default:'),
    ('Longest rim of a hole that is filled; without it', 'Longest border of a hole that is filled; default:'),
    ("Pieces below this diagonal are dropped; without it a hundredth of the whole's", "Pieces with a smaller diagonal are dropped; default: a hundredth of the whole's"),
    ('List the best ways of holding a product, best first', 'List the best placements of a product in the hand, best first'),
    ('without it straight into the surface', 'default: straight into the surface'),
    ('who reaches every point of the surface, with what margin', 'which finger reaches each point of the surface, and with what margin'),
    ('"Places of the surface that the map tries"', '"Number of points of the surface that the map tries"'),
    ('Which posture of a file with several, from 1', 'Posture of a file that has several, counted from 1'),
    ("a unit quaternion W,X,Y,Z; over the file's", 'a unit quaternion W,X,Y,Z; replaces that of the file'),
    ('as seven numbers likewise', 'as seven numbers like the placement'),
    ('relative (every depth counts alike)', 'relative (every depth has the same weight)'),
    ('What the tissue file gives the result to: finger', 'Where the result goes in the tissue file: finger'),
    ('"Or a part of its description"', '"Part of its description, instead of the number"'),
    ('"Looked through with the folders in it"', '"Folder to search, with the folders in it"'),
    ("Part of the series' description, likewise", "Part of the series' description, instead of the number"),
    ('"Lenses, JSON"', '"JSON file to write: the lenses"'),
    ('names like p3_c2.jpg say the camera', 'names like p3_c2.jpg name the camera'),
    ('names like p3_c2.jpg say position and camera', 'names like p3_c2.jpg name position and camera'),
    ('"The mesh, .ply; a report goes beside it"', '"Mesh to write, .ply; a report is written beside it"'),
    ('"Draw hands of a population, one row each"', '"Sample hands of a population, one row each"'),
    ('"How many (random, latin_hypercube)"', '"Number of hands (random, latin_hypercube)"'),
    ('"Boundary hands beside the mean one"', '"Number of boundary hands beside the mean one"'),
    ('Regressed dimensions without the scatter about their regressions', 'Leave out the scatter of regressed dimensions about their regressions'),
    ('Column whose values part the subjects', 'Column whose values group the subjects'),
    ('"How the dimensions of a table go together: r, interval, significance"', '"Correlations between the dimensions of a table: r, interval, significance"'),
    ('"Of confidence"', '"Confidence level"'),
    ('"Of the population; unless given that of its file"', '"Name of the population; default: that of its file"'),
    ('"Of the population, for people"', '"Title of the population, for people"'),
    ('Predictors A,B,...; unless given hand_length and hand_circumference', 'Predictors A,B,...; default: hand_length and hand_circumference'),
    ('Range as 1:15, or one radius that is just made', 'Range as 1:15, or one radius that is made without a search'),
    ('or one value that is just made', 'or one value that is made without a search'),
    ('"Of the hands that must touch: any, half, or 0 to 1"', '"Share of the hands that must touch: any, half, or 0 to 1"'),
    ('"A hand touches where it presses more"', '"Pressure above which a hand counts as touching, MPa"'),
    ('"By which outlines are rounded"', '"Smoothing of the outlines, mm"'),
    ('"Smaller specks and holes are dropped"', '"Smaller patches and holes are dropped, mm2"'),
    ('Of the mean imprint by which the surface is set back before simple surfaces are fitted to it', 'Share of the mean imprint by which the surface is moved inwards before simple surfaces are fitted to it'),
    ('Of the mean imprint that a rounding is fitted to', 'Share of the mean imprint that a rounding is fitted to'),
    ('Ridges are rounded as far as that share of the hands touch them', 'Ridges are rounded over the length that this share of the hands touches'),
    ('"By which a ridge may go back"', '"Largest depth by which a ridge may go back, mm"'),
    ('Of the cutter: ridges get no smaller one', 'Radius of the cutter: ridges get no smaller one, mm'),
    ('"Radius of the arc along which the cutter leaves the product"', '"Radius of the arc along which the cutter leaves the product, mm"'),
    ('"Go on with a study that was stopped"', '"Continue a study that was stopped"'),
    ('Store to write; must not be there yet', 'Store to write; must not exist yet'),
    ('Corrected p values below it name a difference', 'Level of the corrected p value below which a difference is named'),
    ('evenly chosen by hand length', 'chosen evenly by hand length'),
    ('in a folder that all nodes see', 'in a folder that is visible to all nodes'),
    ('The program as the nodes see it; else this one', 'Path of the program on the nodes; default: this one'),
    ('Time to ask for per shard; else three times what a sample grasp suggests', 'Time limit per shard; default: three times the estimate from sample grasps'),
    ('Memory to ask for per shard; else one and a half times that of a sample', 'Memory limit per shard; default: one and a half times that of the sample grasps'),
    ('JSON file to write: posture, placement, what stopped it', 'JSON file to write: posture, placement, what stopped each segment'),
    # the same messages, filled in or in part, as tests look for them
    ("phalanx lie 26 mm apart", "phalanx are 26 mm apart"), ("slices lie in 2 directions", "slices are in 2 directions"),
    ("slices lie in 3 directions", "slices are in 3 directions"), ("doesn't say how the image lies", "doesn't say how the image is oriented"),
    ("mm, lies 5 standard deviations", "mm, is 5 standard deviations"), ('" mm, lies "', '" mm, is "'),
    ('"; skin lies "', '"; skin is "'), ('"triangle stands"', '"triangle is"'), ('"triangles stand"', '"triangles are"'),
    ('"mended "', '"repaired "'), ('" stands"', '" remains"'), ('"tells no product"', '"describes no product"'),
    ('"doesn\'t tell the posture"', '"doesn\'t give the posture"'), ('"tell the posture"', '"give the posture"'),
    ('"lies more than 2 mm"', '"is more than 2 mm"'), ("0 voxels lie in it; 30", "0 voxels are in it; 30"),
    ("slices 1 mm thick lie 1.5 mm apart", "slices 1 mm thick are 1.5 mm apart"), ('"stands twice"', '"appears twice"'),
    (": searched anew", ": searched again"), ('" is asked for; there "', '" is requested; there "'),
    ("an attribute value stands without quotes", "an attribute value has no quotes"), ("another study than the one asked for", "another study than the requested one"),
    ('"askew"', '"isn\'t parallel"'),
    (", but not with its pad, which is {:.0f} degrees askew", ", but not with its pad, which is tilted by {:.0f} degrees"),
]

# 5. Comments (and nothing else): regular expressions, in order.
COMMENTS = [
    (r'\bmade square to\b', 'made perpendicular to'), (r'\bmost square to\b', 'most nearly perpendicular to'),
    (r'\b([Aa])bout square to\b', r'\1bout perpendicular to'), (r'\bSquare to rounding\b', 'Square to rounding'),
    (r'\bSquare to each other\b', 'Perpendicular to each other'), (r'(?<!the )\bsquare to\b', 'perpendicular to'),
    (r'\banew\b', 'again'),
    # told
    (r"\bcan't be told from\b", "can't be distinguished from"), (r"\bisn't told from\b", "isn't distinguished from"),
    (r'\bbe told from\b', 'be distinguished from'), (r'\btold apart\b', 'distinguished'),
    (r"\bcan't be told\b", "can't be determined"), (r'\b(can|could) be told\b', r'\1 be determined'),
    (r'\bto be told\b', 'to be informed'), (r'\bwithout an error being told\b', 'without a given error'),
    (r'\bWithout an error being told\b', 'Without a given error'), (r'\bas told\b', 'as given'), (r'\bsuch told\b', 'such reported'),
    (r'\bnot told\b', 'not given'), (r"\bisn't told\b", "isn't given"), (r'\bWhat surfaces told, laid on\b', 'What surfaces showed, aligned with'),
    (r'\b(dots|skin|bones|image|scans) told\b', r'\1 showed'), (r'\btold by the user\b', 'given by the user'), (r'\btold by the parent\b', 'reported by the parent'), (r'\btold by\b', 'recognised by'), (r'\btold to stop\b', 'asked to stop'),
    (r'\bmotion told for\b', 'motion expressed for'), (r'\btold this\b', 'reported this'), (r'\btold in full\b', 'reported in full'),
    (r'\btold them\b', 'given them'), (r'\bpeople are told of them\b', 'people are informed of them'), (r'\bare told of\b', 'are reported for'), (r'\btold of the\b', 'reported the'), (r'\btold of\b', 'reported'),
    (r'\btold\b', 'reported'), (r'\bTold\b', 'Reported'), (r'\buntold\b', 'not reported'), (r'\bforetells\b', 'predicts'),
    # tell
    (r'\bnothing to tell\b', 'nothing to report'), (r'\bworth telling\b', 'worth reporting'),
    (r'\bto tell (\w+ ){1,3}from\b', lambda m: m.group(0).replace('to tell', 'to distinguish')),
    (r'\btells? ((?:\w+ ){1,6}?)apart\b', lambda m: 'distinguishes ' + m.group(1).strip()),
    (r'\bwhich tells products of\b', 'which keeps products of'), (r'\btells one from\b', 'distinguishes one from'),
    (r"\bdon't tell from\b", "don't distinguish from"), (r"\bsystem doesn't tell\b", "system doesn't say"), (r'\btells of\b', 'describes'),
    (r'\btell of\b', 'describe'), (r"\bname tells\b", 'name gives'), (r'\bheader tells Palmar\b', 'header names Palmar'),
    (r'\bfile tells no names\b', 'file has no names'), (r'\btells (which|how|what|where|that|whether)\b', r'says \1'),
    (r'\bturn_error tells\b', 'turn_error says so'), (r'\bnever come to lie as they lay\b', 'are never where they were'),
    (r"^/// lay as that hand's", "/// pose as that hand's"), (r'\bto tell\b', 'to determine'),
    (r"\b(can't|can) tell\b", r'\1 determine'), (r"\b(doesn't|don't|didn't) tell\b", r'\1 show'),
    (r'\btells nothing\b', 'shows nothing'), (r'\btells\b', 'shows'), (r'\bTells\b', 'Says'), (r'\btell\b', 'show'),
    # lay
    (r'\bthe usual lay\b', 'the usual pose'), (r'\b(same|kept|its|usual|one|a) lay\b', r'\1 pose'), (r'\blays differ\b', 'poses differ'),
    (r'\bThe lay that\b', 'The pose that'), (r'\ba lay\b', 'a pose'),
    (r'\blaid back onto\b', 'projected back onto'), (r'\blaid again\b', 'found again'), (r'\blaid through\b', 'fitted through'),
    (r'\blaid into\b', 'fitted into'), (r'\blaid round\b', 'put round'), (r'\blaid flat\b', 'flattened'),
    (r'\blaid onto\b', 'projected onto'), (r'\blaid over\b', 'placed over'), (r'\blaid across\b', 'placed across'),
    (r'\blaid along\b', 'placed along'), (r'\blaid on\b', 'placed on'), (r'\blaid as\b', 'placed as'),
    (r'\blaid by\b', 'placed by'), (r'(?<!`)\blaid\b(?! out)(?!\.\w)(?!_)', 'placed'), (r'\bLays down which\b', 'Determines which'), (r'\bLays the test out\b', 'Sets the test up'),
    (r'\blays (\w+ )?out\b', r'lays \1out'), (r'\bLays\b', 'Places'), (r'\blays\b(?!( \w+)? out)', 'places'), (r'\bto lay on\b', 'to place'),
    (r'\bthose that lay the\b', 'those that align the'), (r'\bhow the model lay in\b', 'where the model was in'),
    (r'\bas it lay\b', 'as it was'), (r'\blie as they lay\b', 'be where they were'),
    # others
    (r'\bgoes along with\b', 'follows'), (r'\bSurroundings go along\b', 'Surroundings move with it'),
    (r'\bp0 goes along\b', 'p0 changes with it'), (r'\bif there are any, go along\b', 'if there are any, are kept'),
    (r"\bcan't be made good\b", "can't be compensated"), (r'\bmade good\b', 'corrected'),
    (r'\bis drawn in to\b', 'is shrunk towards'), (r'\bdrawn in towards\b', 'shrunk towards'), (r'\bis drawn in\b(?! the)', 'is made smaller'),
    (r'\bparted by\b', 'separated by'), (r'\bparted\b', 'separated'), (r'\bthat part regions\b', 'that separate regions'),
    (r'\bdeep films part\b', 'deep films separate'), (r'\bbettered\b', 'improved'), (r'\bmended\b', 'repaired'),
    (r'\baslant\b', 'obliquely'), (r'\blies askew\b', 'is oblique'), (r'\blie askew\b', 'be oblique'), (r'\baskew\b', 'oblique'),
]

# ------------------------------------------------------------------------------------------------
def tracked():
    out = subprocess.run(['git', '-C', root, 'ls-files'], capture_output=True, text=True, check=True).stdout.split('\n')
    return [f for f in out if f and not f.startswith('node_modules/')]

CODE = re.compile(r'\.(h|cpp|hpp)$')
SCRIPT = re.compile(r'\.(ts|mjs|js)$')
DOC = re.compile(r'\.md$')
LEX = re.compile(r'''(?P<raw>R"(?P<d>[^()\s\\]{0,16})\(.*?\)(?P=d)")|(?P<line>//[^\n]*)|(?P<block>/\*.*?\*/)|(?P<str>"(?:[^"\\\n]|\\.)*")|(?P<chr>'(?:[^'\\\n]|\\.)+')''', re.S)

def segments(text):
    """(kind, text): code, comment, string, raw, char."""
    at = 0
    for m in LEX.finditer(text):
        if m.lastgroup == 'chr' and m.start() and text[m.start() - 1].isalnum():  # 1'000
            continue
        if m.start() < at:
            continue
        if m.start() > at:
            yield 'code', text[at:m.start()]
        kind = 'comment' if m.group('line') or m.group('block') else 'raw' if m.group('raw') else 'string' if m.group('str') else 'char'
        yield kind, m.group(0)
        at = m.end()
    if at < len(text):
        yield 'code', text[at:]

def word_re(words):
    return re.compile(r'(?<![\w])(' + '|'.join(sorted(map(re.escape, words), key=len, reverse=True)) + r')(?![\w])') if words else None

every_re = word_re(EVERYWHERE)
local_re = [(stem, names, word_re(names)) for stem, names in LOCAL]
code_only_re = word_re(CODE_ONLY)
test_name = re.compile(r'(\b(?:TEST|TEST_F|TEST_P|TYPED_TEST)\(\s*\w+\s*,\s*)(\w+)')
comments = [(re.compile(a), b) for a, b in COMMENTS]

def phrase(text):
    for old, new in PHRASES:
        if old.startswith('"') and old.endswith('"'):
            if text == old: return new
            continue
        text = text.replace(old, new)
    return text

def strings(segs):
    """Adjacent literals joined, changed by PHRASES, put back as one literal where anything changed."""
    out, i = [], 0
    while i < len(segs):
        kind, text = segs[i]
        if kind != 'string':
            out.append((kind, text)); i += 1; continue
        j, group = i, [text]
        while j + 2 < len(segs) and segs[j + 1][0] == 'code' and segs[j + 1][1].strip() == '' and segs[j + 2][0] == 'string':
            group.append(segs[j + 2][1]); j += 2
        joined = '"' + ''.join(g[1:-1] for g in group) + '"'
        changed = phrase(joined)
        if changed != joined:
            out.append(('string', changed))
        else:
            out.extend(segs[i:j + 1])
        i = j + 1
    return out

COMMENT_TRIGGER = re.compile(r"square|anew|[Tt]old|[Tt]ell|[Ll]ay|laid|go(es)? along|made good|drawn in|part|better|mend|aslant|askew")

def comment(text):
    if not COMMENT_TRIGGER.search(text): return text
    for pattern, new in comments:
        text = pattern.sub(new, text)
    return text

def transform(path, text):
    if DOC.search(path):
        text = every_re.sub(lambda m: EVERYWHERE[m.group(1)] if '`' in text else m.group(1), text) if False else text
        for old, new in PHRASES:
            if '"' not in old: text = text.replace(old, new)
        return text
    if SCRIPT.search(path):
        for old, new in PHRASES:
            if '"' not in old: text = text.replace(old, new)
        return text
    stem = os.path.basename(path)
    segs = strings(list(segments(text)))
    names, pattern = {}, None
    for s, n, p in local_re:
        if stem.startswith(s): names.update(n)
    pattern = word_re(names)
    result = []
    for kind, part in segs:
        if kind == 'code':
            part = every_re.sub(lambda m: EVERYWHERE[m.group(1)], part)
            if pattern: part = pattern.sub(lambda m: names[m.group(1)], part)
            part = code_only_re.sub(lambda m: CODE_ONLY[m.group(1)], part)
            def test(m):
                name = m.group(2)
                for old, new in TESTS: name = name.replace(old, new)
                return m.group(1) + name
            part = test_name.sub(test, part)
        elif kind == 'comment':
            part = every_re.sub(lambda m: EVERYWHERE[m.group(1)], part)
            part = comment(part)
        result.append(part)
    return ''.join(result)

files = [f for f in tracked() if CODE.search(f) or SCRIPT.search(f) or DOC.search(f)]
files = [f for f in files if os.path.isfile(os.path.join(root, f)) and not os.path.islink(os.path.join(root, f))
         and not f.endswith('docs/method/validation.md') and 'words_rename' not in f]
before = {f: open(os.path.join(root, f), encoding='utf-8', errors='surrogateescape').read() for f in files}

# Collisions: a new name that is there already, in code, although the old one is too.
problems = []
code_words = {f: set(re.findall(r'[A-Za-z_]\w*', ''.join(t for k, t in segments(text) if k == 'code'))) for f, text in before.items() if CODE.search(f)}
anywhere = {}
for f, words in code_words.items():
    for w in words: anywhere.setdefault(w, []).append(f)
for old, new in EVERYWHERE.items():
    if old in anywhere and new in anywhere: problems.append(f'{old} -> {new}: exists in {anywhere[new][:3]}')
for old, new in CODE_ONLY.items():  # on_note is the workflow's own word: only not both in one file
    for f, words in code_words.items():
        if old in words and new in words: problems.append(f'{f}: {old} -> {new}: both are there')
for stem, names in LOCAL:
    for f, words in code_words.items():
        if os.path.basename(f).startswith(stem):
            for old, new in names.items():
                if old in words and new in words: problems.append(f'{f}: {old} -> {new}: exists there')

after = {f: transform(f, text) for f, text in before.items()}
changed = [f for f in files if after[f] != before[f]]
for f in changed:
    again = transform(f, after[f]) if '--report' in sys.argv else after[f]
    if again != after[f]: problems.append(f'{f}: a second run would change it again')
for p in problems: print('COLLISION', p)
print(f'{len(changed)} files change')
if '--report' in sys.argv:
    words = re.compile(r'\b(told|tells?|lies?|stands?|lays?|laid|askew|anew|mended|parted|asked for|goes on|go on|drawn in)\b')
    for f in changed + [x for x in files if x not in changed]:
        if not CODE.search(f): continue
        is_test = '_test' in f or f.startswith('tests/')
        segs = list(segments(after[f]))
        i = 0
        for kind, part in segs:
            if kind == 'string' and words.search(part): print(('TEST ' if is_test else 'LEFT ') + f + ': ' + part[:160])
if dry or (problems and '--force' not in sys.argv):
    sys.exit(1 if problems else 0)
for f in changed:
    open(os.path.join(root, f), 'w', encoding='utf-8', errors='surrogateescape').write(after[f])
code = [os.path.join(root, f) for f in changed if CODE.search(f)]
if shutil.which('clang-format') and code:
    subprocess.run(['clang-format', '-i', *code], check=True)
