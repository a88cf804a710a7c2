// throwaway
#include <fstream>
#include <iostream>
#include "benchmarks/series.h"
#include "runtime/recognize.h"
#include "runtime/pose_evidence.h"
#include "runtime/pose_from_matches.h"
#include "runtime/hypothesis_cliques.h"
#include "runtime/highest_confidence_first.h"
#include "compiler/sensor_file.h"
using namespace foresight;
int main(int argc,char**argv){
  // db sensor seed n clutter most out
  const Database db=load_database(argv[1]);
  SensorModel sensor=std::string(argv[2])=="-"?paper_sensor():read_sensor_file(argv[2]);
  int seed=atoi(argv[3]), n=atoi(argv[4]), clutter=atoi(argv[5]), most=atoi(argv[6]);
  ExperimentOptions o; auto models=read_objects(o,sensor); auto objects=scored_objects(models);
  std::ofstream out(argv[7]);
  out<<"scene,rank,model,present,visible,k,right,indist,s_drawn,s_expl,s_tilt,s_behind,s_front,s_missing,s_owned,drawn,expl,tilt,behind,front,missing,owned,faces,found,residual,alpha,beta,gamma,ms\n";
  ViewingSphere sphere(kAspectCells);
  for(int i=0;i<n;++i){
    Scene scene = clutter? generate_scene(models,sensor,{4,6,sensor.background},seed,i): single_object_scene(models,sensor,sensor.background,seed,i);
    const RangeImage& image=scene.scan.image;
    auto regions=extract_regions(image,sensor.camera,db.content().segmentation);
    std::vector<Region> rs; for(auto&r:regions) rs.push_back(r.region);
    LabelledScan ls{image,sensor.camera,sensor,regions,label_image(rs,image.size())};
    auto bg=background_for(db.content().density);
    auto matches=match_likelihoods(regions,db,bg);
    auto field=build_hypothesis_field(regions,matches,db,bg,{});
    auto labels=highest_confidence_first(field);
    auto hyps=hypothesis_cliques(field,db,labels);
    NearestDataPoint data(image);
    int done=0;
    Random rnd(seed,i);
    for(size_t h=0;h<hyps.size()&&done<most;++h){
      if(h>=20 && hyps.size()>200) h+=rnd.integer(0,(int)hyps.size()/most);
      if(h>=hyps.size()) break;
      auto&hy=hyps[h];
      std::vector<RegionFaceMatch> ms; for(int m:hy.matches) ms.push_back({&regions[field.matches[m].region],&db.face(field.matches[m].face)});
      auto start=pose_from_matches(ms); if(!start) continue;
      ++done;
      const CompiledModel& model=db.models()[hy.model];
      auto t0=std::chrono::steady_clock::now();
      EvidenceOptions loose; loose.distance=8;
      auto s=gather_evidence(model,*start,ls,loose);
      double ms1=std::chrono::duration<double,std::milli>(std::chrono::steady_clock::now()-t0).count();
      bool hopeless = s.explained < 0.2*s.drawn || s.drawn==0;
      Pose p=*start; Verification v; 
      if(!hopeless){ p=localize(model,sphere,*start,data,{}).T_sensor_model; v=verify(model,sphere,p,image,sensor.camera,data,{});}
      auto e=gather_evidence(model,p,ls);
      bool present=false,right=false,ind=false; double vis=0;
      for(auto&so:scene.objects) if(models[so.model].name==model.name){ present=true; vis=so.visible_fraction; right=mssd(objects[so.model],p,so.T_sensor_model)<=objects[so.model].tolerance();}
      out<<i<<","<<h<<","<<model.name<<","<<present<<","<<vis<<","<<hy.matches.size()<<","<<right<<","<<ind<<","<<s.drawn<<","<<s.explained<<","<<s.tilted<<","<<s.behind<<","<<s.front<<","<<s.missing<<","<<s.owned<<","<<e.drawn<<","<<e.explained<<","<<e.tilted<<","<<e.behind<<","<<e.front<<","<<e.missing<<","<<e.owned<<","<<e.faces<<","<<e.faces_found<<","<<e.residual<<","<<v.matched<<","<<v.coherent<<","<<v.occluding<<","<<ms1<<"\n";
    }
  }
}
