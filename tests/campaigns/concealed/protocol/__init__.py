"""Proves `flexcomp diagnose` blind: the truth is sealed before it runs and opened after."""
