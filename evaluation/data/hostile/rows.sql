-- The rows that are kept of a campaign: sqlite3 -csv -header F.db < rows.sql > F.csv
SELECT trial AS flight, seed,
       (SELECT value FROM variation v WHERE v.trial = t.trial AND key = 'family') AS family,
       (SELECT value FROM variation v WHERE v.trial = t.trial AND key = 'beyond') AS beyond,
       (SELECT value FROM variation v WHERE v.trial = t.trial AND key = 'way') AS way,
       landed, outcome, cause,
       printf('%.4g', time_to_land_s) AS time_to_land_s, printf('%.4g', simulated_s) AS simulated_s,
       printf('%.3g', min_clearance_m) AS min_clearance_m,
       safety_uncertified_steps AS uncertified, safety_escaping_steps AS escaping,
       safety_narrow_steps AS narrow, safety_stops_flown AS stops, safety_map_errors AS map_errors,
       printf('%.3g', safety_margin_mean_m) AS margin_mean_m,
       printf('%.3g', safety_margin_max_m) AS margin_max_m,
       safety_tracking_events AS tracking, printf('%.3g', safety_tracking_max_m) AS tracking_max_m,
       safety_drift_events AS drift, printf('%.3g', safety_drift_max_m) AS drift_max_m,
       safety_free_cells AS free_cells, safety_falsely_free_cells AS falsely_free_cells
FROM trial t ORDER BY trial;
