"""Other ways to predict what the nominal model cannot, on the same data as `flexcomp diagnose`.

Each learns from the training recordings alone and is judged on recordings it has not seen.
"""
