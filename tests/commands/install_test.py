"""What `cmake --install` puts in place runs there.

usage: install_test.py CMAKE BUILD_FOLDER
"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path


class Install(unittest.TestCase):
    def test_the_installed_program_runs_and_is_all_there_is(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([CMAKE, "--install", BUILD, "--prefix", folder], check=True, capture_output=True)
            program = Path(folder) / "bin" / "strainfinger"
            self.assertEqual([program], [path for path in Path(folder).rglob("*") if path.is_file()])
            run = subprocess.run([program, "response", "--radius-m", "9.4e-3", "--harmonics", "1"], cwd=folder,
                                 capture_output=True, text=True, check=True)
            self.assertTrue(run.stdout.startswith("n,err_p,"), run.stdout)


if __name__ == "__main__":
    CMAKE, BUILD = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1], verbosity=2)
